#include "io/sweep_folder.hpp"

#include "io/case_pool.hpp"
#include "io/json.hpp"
#include "io/run.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <system_error>

namespace grandamp {

namespace {

namespace fs = std::filesystem;

Json json_of(const FolderIdentity& identity) {
  Json json{{"command", identity.command}};
  for (const auto& [what, value] : identity.entries) json[what] = value;
  json["scene"] = identity.scene;
  return json;
}

/// The first line in which two texts differ.
std::string difference_of(const std::string& there, const std::string& here) {
  std::istringstream a(there), b(here);
  std::string one, other;
  for (int line = 1;; ++line) {
    const bool more = static_cast<bool>(std::getline(a, one)), also = static_cast<bool>(std::getline(b, other));
    if (!more) one = "(its end)";
    if (!also) other = "(its end)";
    if (one != other || (!more && !also))
      return fmt::format("line {} is \"{}\" there and \"{}\" here", line, one, other);
  }
}

std::vector<std::string> differences(const Json& there, const FolderIdentity& here) {
  std::vector<std::string> found;
  const auto text = [&there](const std::string& key) {
    return there.contains(key) && there[key].is_string() ? there[key].get<std::string>() : std::string("nothing");
  };
  for (const auto& [what, value] : here.entries)
    if (text(what) != value) found.push_back(fmt::format("{}: {} there, {} here", what, text(what), value));
  if (text("scene") != here.scene) found.push_back("scene: " + difference_of(text("scene"), here.scene));
  return found;
}

std::string in_a_sentence(const std::string& command) {
  return command == "optimise" ? "optimisation" : command;
}

fs::path mark_of(const fs::path& folder, const std::string& command) {
  return folder / (command + ".of.json");
}

void demand_the_same(const fs::path& folder, const fs::path& mark, const FolderIdentity& identity) {
  std::ifstream stream(mark);
  const Json there = Json::parse(stream, nullptr, false);
  const std::vector<std::string> found =
      there.is_object() ? differences(there, identity) : std::vector<std::string>{mark.string() + " is damaged"};
  if (found.empty()) return;
  throw UsageError(fmt::format("{}: holds another {} ({}); choose another folder with -o, or replace it with --force",
                               folder.string(), in_a_sentence(identity.command), fmt::join(found, "; ")));
}

/// A folder that is not there yet, or empty, or that --force lets be added to; never one of a run or another command.
void demand_room(const fs::path& folder, const std::string& command, bool force) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(".new")) continue; // of whoever begins the same at this moment
    const bool of_another = file == "summary.json" || file == "results.h5" || file == "checkpoint.h5" ||
                            file == "study.toml" || file.ends_with(".of.json");
    if (!force || of_another)
      throw UsageError(fmt::format("{}: holds something that is no {} ({}); choose another folder with -o{}",
                                   folder.string(), in_a_sentence(command), file,
                                   of_another ? "" : ", or add to it with --force"));
  }
}

} // namespace

void claim_folder(const fs::path& folder, const FolderIdentity& identity, bool force) {
  std::error_code error;
  const fs::path mark = mark_of(folder, identity.command);
  const fs::file_status status = fs::status(folder, error);
  if (fs::exists(status) && !fs::is_directory(status))
    throw FileError(folder.string() + ": is a file, not a folder; choose another with -o");
  const bool mine = fs::exists(mark, error);
  if (mine && !force) demand_the_same(folder, mark, identity);
  if (!mine) demand_room(folder, identity.command, force);
  if (mine && force) fs::remove_all(folder / "runs", error);
  if (error) throw FileError((folder / "runs").string() + ": cannot remove the runs of before: " + error.message());
  // The mark comes first: whoever else begins the same in this folder at this moment finds nothing, or the mark.
  fs::create_directories(folder, error);
  if (error) throw FileError(folder.string() + ": cannot make the folder: " + error.message());
  if (!mine || force)
    replace_shared_file(mark, json_of(identity).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  if (force || !fs::exists(folder / "scene.toml", error)) replace_shared_file(folder / "scene.toml", identity.scene);
  fs::create_directories(folder / "runs", error);
  if (error) throw FileError(folder.string() + ": cannot make the folder: " + error.message());
}

TableLock::TableLock(const fs::path& folder, const std::string& command)
    : file_(open(mark_of(folder, command).c_str(), O_RDWR | O_CLOEXEC)) {
  if (file_ >= 0) flock(file_, LOCK_EX);
}

TableLock::~TableLock() {
  if (file_ >= 0) close(file_);
}

} // namespace grandamp
