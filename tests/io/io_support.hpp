// Folders that go away with the test, files as text, and the program run as a user runs it.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace grandamp::test {

class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "grandamp-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("no file " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_content(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Outcome {
  int status = -1;
  std::string output; ///< standard output
  std::string errors; ///< standard error
};

/// A command of the shell, in `folder`.
inline Outcome shell(const TemporaryFolder& folder, const std::string& command) {
  const std::string output = (folder / "shell.out").string();
  const std::string errors = (folder / "shell.err").string();
  const std::string all = "cd '" + folder.path().string() + "' && { " + command + "\n} >" + output + " 2>" + errors;
  const int status = std::system(all.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content_of(output), content_of(errors)};
}

inline Outcome program(const TemporaryFolder& folder, const std::string& arguments) {
  return shell(folder, std::string(GRANDAMP_PROGRAM) + " " + arguments);
}

/// Eight granules in a box that a structure carries: a run of a fraction of a second of wall time.
inline std::string small_scene() {
  return R"(title = "Eight granules"
seed = 3
gravity = [0.0, 0.0, -9.81]

[enclosure]
shape = "box"
size = [0.01, 0.01, 0.012]

[[granules]]
name = "acrylic"
count = 8
radius = 1.5e-3
density = 1190.0

[packing]
kind = "random"

[contact.granule]
stiffness = 1.0e7
reference_radius = 3.0e-3
restitution = 0.89
friction = 0.52

[structure]
mass = 0.02
stiffness = 200.0
damping = 0.05

[excitation]
kind = "harmonic"
force = 0.5
frequency = 16.0

[time]
duration = 0.05
step = 5.0e-6

[output]
history_interval = 1.0e-3
)";
}

} // namespace grandamp::test
