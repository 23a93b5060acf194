// The folder of a sweep or an optimisation, which several programs may share. Internal to io.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace grandamp {

/// What a folder is of, entry by entry: two are the same if all entries are.
struct FolderIdentity {
  std::string command;                                      ///< "sweep" or "optimise"
  std::vector<std::pair<std::string, std::string>> entries; ///< what is told of a difference, and the value
  std::string scene;                                        ///< the text of the scene
};

/// Makes the folder, or sees that it is of the same: `scene.toml` and `COMMAND.of.json` in it say whose it is.
/// Throws UsageError (it holds something else; tells what differs), FileError.
void claim_folder(const std::filesystem::path& folder, const FolderIdentity& identity, bool force);

/// While it lives nobody else writes the tables in the folder (where the file system has locks).
class TableLock {
public:
  TableLock(const std::filesystem::path& folder, const std::string& command);
  ~TableLock();
  TableLock(const TableLock&) = delete;
  TableLock& operator=(const TableLock&) = delete;

private:
  int file_ = -1;
};

} // namespace grandamp
