// The folder of a run: what it holds, and what a new run may replace in it.
#pragma once

#include "io/checkpoint.hpp"

#include <filesystem>
#include <string>

namespace grandamp {

class RunFolder {
public:
  /// Makes the folder if need be and makes sure that it can be written to; files in it stay as they are.
  /// Throws UsageError if it holds a run and `force` is false, or while another program runs in it, FileError if it
  /// cannot be made or written to.
  RunFolder(std::filesystem::path folder, bool force);
  /// The folder of a run that is to go on. Throws FileError if there is none or it cannot be written to.
  static RunFolder of_run(std::filesystem::path folder);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  std::filesystem::path scene() const { return folder_ / "scene.toml"; }
  std::filesystem::path summary() const { return folder_ / "summary.json"; }
  std::filesystem::path results() const { return folder_ / "results.h5"; }
  std::filesystem::path trace() const { return folder_ / "trace.json"; }
  /// "response" or "decay", with an ending.
  std::filesystem::path file(const char* name) const { return folder_ / name; }
  CheckpointFiles checkpoints() const { return CheckpointFiles(folder_); }

  /// Removes the files of an earlier run, and nothing else, and writes scene.toml: once, and never in the folder of a
  /// run that goes on. Throws FileError.
  void begin(const std::string& scene_text);
  /// A run that is to change what summary.json, trace.json, response.* and decay.* tell of must not leave them if it is
  /// killed.
  void forget_summary();
  /// Removes the folder again if it was made for this run and is empty.
  void abandon() noexcept;

private:
  struct Existing {};
  RunFolder(std::filesystem::path folder, Existing);
  void lock();
  void unlock() noexcept;
  void remove_leftovers() noexcept; ///< of writing that a kill cut short

  std::filesystem::path folder_;
  bool made_ = false;
  bool begun_ = false;
  int locked_ = -1; ///< file descriptor of the folder
};

} // namespace grandamp
