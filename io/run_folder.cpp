#include "io/run_folder.hpp"

#include "io/run.hpp"
#include "io/text_file.hpp"

#include <system_error>
#include <utility>

namespace grandamp {
namespace {

namespace fs = std::filesystem;

/// Access rights alone do not tell (root, read-only and full file systems): try it.
void try_to_write(const fs::path& folder) {
  const fs::path probe = folder / ".grandamp-write-test";
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
    for (const fs::path& file : {scene(), summary(), results()}) {
      if (fs::exists(file, error)) {
        throw UsageError(folder_.string() + ": holds a run already (" + file.filename().string() +
                         "); choose another folder with -o, or replace the run with --force");
      }
    }
  }
  made_ = fs::create_directories(folder_, error);
  if (error) throw FileError(folder_.string() + ": cannot make the folder: " + error.message());
  try {
    try_to_write(folder_);
  } catch (...) {
    abandon();
    throw;
  }
}

void RunFolder::begin(const std::string& scene_text) {
  for (const fs::path& file : {summary(), results()}) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw FileError(file.string() + ": cannot remove the file of the earlier run: " + error.message());
  }
  replace_file(scene(), scene_text);
}

void RunFolder::abandon() noexcept {
  std::error_code ignored;
  if (made_) fs::remove(folder_, ignored); // removes nothing that is not empty
}

} // namespace grandamp
