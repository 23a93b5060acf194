#include "io/run_folder.hpp"

#include "io/run.hpp"
#include "io/text_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace grandamp {
namespace {

namespace fs = std::filesystem;

constexpr const char* probe_name = ".grandamp-write-test";

void remove_earlier(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw FileError(file.string() + ": cannot remove the file of the earlier run: " + error.message());
}

/// Access rights alone do not tell (root, read-only and full file systems): try it.
void try_to_write(const fs::path& folder) {
  const fs::path probe = folder / probe_name;
  try {
    TextFile file(probe);
    file.write("a line\n");
    file.close();
  } catch (const FileError& error) {
    std::error_code ignored;
    fs::remove(probe, ignored);
    throw FileError(folder.string() + ": the folder cannot be written to (" + error.what() + ")");
  }
  std::error_code ignored;
  fs::remove(probe, ignored);
}

} // namespace

RunFolder::RunFolder(fs::path folder, bool force) : folder_(std::move(folder)) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_, error);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw FileError(folder_.string() + ": is a file, not a folder; choose another with -o");
  }
  if (!force) {
    for (const fs::path& file : {scene(), summary(), results(), checkpoints().newest}) {
      if (fs::exists(file, error)) {
        throw UsageError(folder_.string() + ": holds a run already (" + file.filename().string() +
                         "); choose another folder with -o, or replace the run with --force");
      }
    }
  }
  made_ = fs::create_directories(folder_, error);
  if (error) throw FileError(folder_.string() + ": cannot make the folder: " + error.message());
  try {
    lock();
    try_to_write(folder_);
    remove_leftovers();
  } catch (...) {
    abandon();
    unlock();
    throw;
  }
}

RunFolder::~RunFolder() {
  unlock();
}

RunFolder RunFolder::of_run(fs::path folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw FileError(folder.string() + ": there is no such folder");
  return RunFolder(std::move(folder), Existing{});
}

RunFolder::RunFolder(fs::path folder, Existing) : folder_(std::move(folder)), begun_(true) {
  try {
    lock();
    try_to_write(folder_);
    remove_leftovers();
  } catch (...) {
    unlock();
    throw;
  }
}

void RunFolder::lock() {
  locked_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // Where a file system has no locks, nothing is locked.
  if (locked_ >= 0 && ::flock(locked_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw UsageError(folder_.string() + ": another program of grandamp is running in this folder");
}

void RunFolder::unlock() noexcept {
  if (locked_ >= 0) ::close(std::exchange(locked_, -1));
}

void RunFolder::remove_leftovers() noexcept {
  for (const char* name :
       {"checkpoint.next.h5.new", "results.h5.new", "history.part.new", "snapshots.part.new", "snapshots.xdmf.new",
        "scene.toml.new", "summary.json.new", "trace.json.new", "response.csv.new", "response.unv.new",
        "response.svg.new", "decay.csv.new", "decay.svg.new", probe_name}) {
    std::error_code ignored;
    fs::remove(folder_ / name, ignored);
  }
}

void RunFolder::begin(const std::string& scene_text) {
  if (begun_) return;
  // The checkpoints first: without results of their own they are of no use, results without them are.
  checkpoints().remove();
  forget_summary();
  remove_earlier(results());
  replace_file(scene(), scene_text);
  begun_ = true;
}

void RunFolder::forget_summary() {
  for (const char* name :
       {"summary.json", "trace.json", "response.csv", "response.unv", "response.svg", "decay.csv", "decay.svg"})
    remove_earlier(folder_ / name);
}

void RunFolder::abandon() noexcept {
  std::error_code ignored;
  if (made_) fs::remove(folder_, ignored); // removes nothing that is not empty
}

} // namespace grandamp
