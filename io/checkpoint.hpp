// checkpoint.h5: the exact state of a run, and what its recording needs to go on. The layout is told in io/FORMAT.md.
#pragma once

#include "io/results.hpp"
#include "solver/errors.hpp"
#include "solver/run_state.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

/// What a run's recording remembers beside the simulation's own state.
struct RecordingState {
  ResultsPosition position;       ///< what was recorded until then
  Sample initial;                 ///< at t = 0
  Sample latest;                  ///< the last row of the histories
  double wall_time = 0.0;         ///< from t = 0, of all parts of the run, s
  double packing_wall_time = 0.0; ///< before t = 0, s
  bool pouring = false;           ///< still before t = 0: the state is of granules being poured
};

struct Checkpoint {
  std::string version;                ///< of the program that wrote it
  std::string isa;                    ///< of its kernels
  std::string scene;                  ///< the scene's text as the run was started
  std::vector<std::string> overrides; ///< KEY=VALUE, given when it went on, in order
  RunState state;
  RecordingState recording;
};

/// The checkpoints of a run's folder. There are two, so that one is whole at any time.
struct CheckpointFiles {
  explicit CheckpointFiles(const std::filesystem::path& folder);

  std::filesystem::path newest;   ///< checkpoint.h5
  std::filesystem::path previous; ///< checkpoint.previous.h5
  std::filesystem::path next;     ///< checkpoint.next.h5: whole, but not yet in its place; only a kill leaves it
  bool newest_is_damaged = false; ///< it is then replaced, and must not take the place of its whole predecessor

  /// Whether there is any of them.
  bool any() const;
  /// Removes all of them. Throws FileError.
  void remove() const;
  /// Moves `next`, if a kill left it, to where it belongs. Throws FileError.
  void settle();
};

/// Writes a new checkpoint beside the others, synced, then moves each up a place. Throws FileError; the others are then
/// as they were.
void write_checkpoint(CheckpointFiles& files, const Checkpoint& checkpoint);

/// A whole checkpoint of another format: of an earlier or later program.
class OtherFormat : public FileError {
public:
  using FileError::FileError;
};

/// Throws FileError with the reason if the file is damaged, cut or no checkpoint, OtherFormat if it is of another
/// format.
Checkpoint read_checkpoint(const std::filesystem::path& file);

struct FoundCheckpoint {
  Checkpoint checkpoint;
  std::filesystem::path file;
  std::vector<std::string> damaged; ///< newer ones that could not be used: what is wrong with each
  bool newest_is_damaged = false;   ///< files.newest is among those
};

/// The newest whole one. Throws FileError if there is none, OtherFormat if it is of another format.
FoundCheckpoint find_checkpoint(const CheckpointFiles& files);

} // namespace grandamp
