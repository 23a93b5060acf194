#include "io/scene_file.hpp"

#include "io/scene_reader.hpp"
#include "io/scene_toml.hpp"
#include "io/scene_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace grandamp {

namespace {

/// With control characters spelled out: a message must not play tricks on a terminal.
std::string printable(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      result += c == '\n' ? std::string("\\n") : fmt::format("\\x{:02x}", byte);
    else
      result += c;
  }
  return result;
}

int line_in(const std::map<std::string, int>& lines, std::string_view key) {
  while (true) {
    const auto found = lines.find(std::string(key));
    if (found != lines.end()) return found->second;
    const std::size_t dot = key.rfind('.');
    if (dot == std::string_view::npos) return 0;
    key = key.substr(0, dot);
  }
}

/// Reads one document; each step leaves what the next one needs.
class DocumentReader {
public:
  DocumentReader(std::string text, const std::string& name) : name_(name), tree_(parse_toml(text)) {
    document_.text = std::move(text);
    document_.lines = lines_of(tree_);
    reading_.folder = std::filesystem::path(name).parent_path();
  }

  SceneDocument read(const std::vector<std::string>& overrides) {
    if (overrides.empty()) {
      document_.scene = read_tree(tree_, reading_);
    } else {
      const std::set<std::string> already_idle = idle_keys_as_written();
      for (const std::string& one : overrides) apply_override(tree_, one, reading_);
      const std::vector<Finding> override_faults = reading_.findings;
      do {
        reading_.findings = override_faults;
        document_.scene = read_tree(tree_, reading_);
      } while (take_out_idle_keys(already_idle));
    }
    if (!reading_.findings.empty()) fail();
    const bool moved = make_file_paths_absolute();
    for (const auto& [key, source] : reading_.overridden) document_.lines[key] = 0;
    if (moved || !overrides.empty()) document_.text = heading(overrides) + write_scene_tree(tree_);
    return std::move(document_);
  }

private:
  /// A key that does not apply even without the overrides is a fault of the file.
  std::set<std::string> idle_keys_as_written() {
    read_tree(tree_, reading_);
    std::set<std::string> keys;
    for (const Finding& finding : reading_.findings)
      if (finding.idle) keys.insert(finding.problem.key);
    reading_.findings.clear();
    return keys;
  }

  bool take_out_idle_keys(const std::set<std::string>& already_idle) {
    bool any = false;
    for (const Finding& finding : reading_.findings) {
      const std::string& key = finding.problem.key;
      if (!finding.idle || already_idle.contains(key) || reading_.is_overridden(key)) continue;
      Problem note = finding.problem;
      note.message += "; an override left it idle";
      note.allowed.clear();
      note.note = true;
      note.line = line_in(document_.lines, key);
      document_.notes.push_back(std::move(note));
      erase_key(tree_, key);
      any = true;
    }
    return any;
  }

  [[noreturn]] void fail() {
    std::vector<Problem> problems;
    bool files_alone = true;
    for (Finding& finding : reading_.findings) {
      Problem& problem = finding.problem;
      const std::string source = reading_.override_of(problem.key);
      if (source.empty())
        problem.line = line_in(document_.lines, problem.key);
      else if (problem.message.find("--set") == std::string::npos)
        problem.message += fmt::format(" (given by --set {})", source);
      files_alone = files_alone && finding.unreadable;
      problems.push_back(std::move(problem));
    }
    std::stable_sort(problems.begin(), problems.end(),
                     [](const Problem& a, const Problem& b) { return a.line < b.line; });
    if (files_alone) throw FileError(format_problems(name_, problems));
    throw SceneError(std::move(problems));
  }

  bool make_absolute(const std::string& key) {
    const std::optional<std::string> file = tree_.at_path(key).value<std::string>();
    if (!file || std::filesystem::path(*file).is_absolute()) return false;
    const std::filesystem::path absolute = std::filesystem::absolute(reading_.folder / *file).lexically_normal();
    replace_string(tree_, key, absolute.string());
    return true;
  }

  bool make_file_paths_absolute() {
    bool any = tree_["excitation"].is_table() && make_absolute("excitation.file");
    const toml::array* populations = tree_["granules"].as_array();
    for (std::size_t i = 0; populations != nullptr && i < populations->size(); ++i) {
      const std::optional<std::string> file = (*populations)[i].as_table()->get_as<std::string>("file") != nullptr
                                                  ? (*populations)[i].at_path("file").value<std::string>()
                                                  : std::nullopt;
      if (!file || std::filesystem::path(*file).is_absolute()) continue;
      const std::filesystem::path absolute = std::filesystem::absolute(reading_.folder / *file).lexically_normal();
      replace_string(tree_, fmt::format("granules.{}.file", i), absolute.string());
      any = true;
    }
    return any;
  }

  std::string heading(const std::vector<std::string>& overrides) const {
    std::string text = fmt::format("# {}, as run\n", printable(name_));
    for (const std::string& one : overrides) text += fmt::format("# --set {}\n", printable(one));
    return text + '\n';
  }

  std::string name_;
  toml::table tree_;
  SceneReading reading_;
  SceneDocument document_;
};

} // namespace

SceneDocument read_scene_text(std::string text, const std::string& name, const std::vector<std::string>& overrides) {
  return DocumentReader(std::move(text), name).read(overrides);
}

SceneDocument read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  constexpr std::size_t most = std::size_t{65} << 20; // more than the parser takes, so that it says so
  const auto refuse = [&file](const char* why) {
    throw FileError(fmt::format("{}: cannot be read: {}", file.string(), why));
  };
  if (std::filesystem::is_directory(file)) refuse("it is a directory");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(std::strerror(errno));
  std::string text;
  std::array<char, 1 << 16> block{};
  while (text.size() < most && stream) {
    stream.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) refuse(std::strerror(errno));
  return read_scene_text(std::move(text), file.string(), overrides);
}

int line_of(const SceneDocument& document, std::string_view key) {
  return line_in(document.lines, key);
}

std::vector<Problem> located(const SceneDocument& document, std::vector<Problem> problems) {
  for (Problem& problem : problems)
    if (problem.line == 0) problem.line = line_of(document, problem.key);
  return problems;
}

std::string format_problems(const std::string& file, const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    text += printable(file);
    if (problem.line > 0) text += fmt::format(":{}", problem.line);
    text += problem.note ? ": note: " : ": ";
    if (!problem.key.empty()) text += printable(problem.key);
    if (!problem.value.empty()) text += " = " + printable(problem.value);
    if (!problem.key.empty() || !problem.value.empty()) text += ": ";
    text += printable(problem.message);
    if (!problem.allowed.empty()) text += "; allowed: " + printable(problem.allowed);
    text += '\n';
  }
  return text;
}

} // namespace grandamp
