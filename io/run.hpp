// One call that does all that `grandamp run` does: the run itself, its folder, its files.
#pragma once

#include "io/scene_file.hpp"
#include "solver/simulation.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace grandamp {

/// Something asked for that cannot be done as asked, though the scene is good. Exit status 2.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// How far a run is.
struct RunProgress {
  bool pouring = false; ///< still before t = 0; then only `time` (of the pouring) and `pouring_energy` mean something
  double pouring_energy = 0.0;     ///< mean kinetic energy per granule over m g d; at rest below 1e-6
  double time = 0.0;               ///< simulated, s
  double duration = 0.0;           ///< to be simulated, s
  double wall_time = 0.0;          ///< since t = 0, s
  double rate = 0.0;               ///< granule-steps per second of wall time
  std::optional<double> amplitude; ///< of the structure over the last whole period (half the peak-to-peak), m
};

struct RunSceneOptions {
  int threads = 0;       ///< 0: chosen
  std::string isa;       ///< "generic", "avx2", "avx512"; empty: the best this machine runs
  double max_wall = 0.0; ///< s of wall time after which the run stops as if asked to; 0: no end
  bool force = false;    ///< replace the files of a run that the folder holds already
  bool profile = false;  ///< time by phase in the summary, and a trace of the beginning in trace.json
  /// Told before anything runs what is worth knowing of the scene, if there is anything.
  std::function<void(const std::vector<Problem>&)> notes;
  /// Told about ten times a second of wall time, and at the end.
  std::function<void(const RunProgress&)> progress;
  /// Told what is worth knowing as the run goes.
  std::function<void(const std::string&)> warning;
  /// Asked at every step; once true the run stops there, a checkpoint and what it has is written.
  std::function<bool()> stop_requested;
  /// Asked at every step; a checkpoint is written when true.
  std::function<bool()> checkpoint_requested;
};

enum class RunStatus { done, interrupted, stopped_by_guard, done_before };

struct RunResult {
  RunStatus status = RunStatus::done;
  std::string message;                        ///< why it stopped before the end; empty when done
  std::int64_t steps = 0;                     ///< done
  double time = 0.0;                          ///< simulated, s
  std::optional<ResponseStatistics> response; ///< with a structure
  std::string summary; ///< the text of summary.json; empty if the run was interrupted before t = 0 and left no files
};

/// Runs the scene and writes scene.toml, summary.json, results.h5 and checkpoints into `folder`, which is made if it is
/// not there. A numerical guard that stops the run after t = 0 is told by the result's status. Throws SceneError,
/// GuardError (the packing comes to no rest), FileError, UsageError (the folder holds a run).
RunResult run_scene(const SceneDocument& document, const std::filesystem::path& folder,
                    const RunSceneOptions& options = {});

/// Goes on with the run in `folder` from its newest whole checkpoint: the results are those of a run that was never
/// stopped. `overrides`, KEY=VALUE, may set time.duration and output intervals for the time to come.
/// Throws FileError (no checkpoint that can be used, a file that cannot be read or written), UsageError (a change that
/// would alter what was simulated already; a checkpoint that this program or machine would not go on from by the same
/// bits), SceneError (an override that makes no sense).
RunResult resume_run(const std::filesystem::path& folder, const std::vector<std::string>& overrides,
                     const RunSceneOptions& options = {});

/// make_plan, with the lines of the document in its notes and in the faults that it throws.
Plan make_located_plan(const SceneDocument& document);

} // namespace grandamp
