// The steps of a run and what is recorded on the way: histories, snapshots, checkpoints, progress. Internal to io.
#pragma once

#include "io/checkpoint.hpp"
#include "io/output_schedule.hpp"
#include "io/results.hpp"
#include "io/run.hpp"
#include "io/run_folder.hpp"
#include "io/summary.hpp"
#include "solver/profile.hpp"

#include <chrono>
#include <limits>
#include <optional>

namespace grandamp {

using WallClock = std::chrono::steady_clock;

double seconds_since(WallClock::time_point start);

/// Half the peak-to-peak of the displacement in the last whole period, from history rows: for the progress line only.
class RecentAmplitude {
public:
  explicit RecentAmplitude(const Scene& scene);
  void add(const Sample& sample);
  std::optional<double> value() const { return value_; }

private:
  double period_ = 0.0;
  double end_ = 0.0;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  std::optional<double> value_;
};

/// What a Recorder is told of its run.
struct RecorderSetup {
  OutputControl output;
  CheckpointFiles checkpoints;
  std::string scene_text;                  ///< as the run was started
  std::vector<std::string> overrides;      ///< KEY=VALUE, given when it went on
  WallClock::time_point begun;             ///< this part of the run, packing included
  double packing_wall_time = 0.0;          ///< s
  const RecordingState* earlier = nullptr; ///< of the parts before this one
  bool checkpoint_first = false;           ///< what was asked of this part is to outlive a kill
};

class Recorder {
public:
  Recorder(Simulation& simulation, ResultsWriter& results, const RunSceneOptions& options, RecorderSetup setup);

  /// All steps that are left, and the end. Throws FileError.
  void go();

  RunRecord record;

private:
  enum class Wish { none, checkpoint, stop };

  void step_to_the_end();
  Wish wish();
  void write_checkpoint_now();
  Checkpoint checkpoint() const;
  void stop(std::string why);
  void keep(const Sample& sample);
  void take_snapshot_if_due();
  void look_at_the_clock();
  bool asked_for_something(); ///< while a fold goes on, which may take as long as the results are large
  void tell_warnings();
  void tell_progress();
  Profile* profile() { return options_.profile ? &profile_ : nullptr; }
  double wall_time() const { return earlier_wall_time_ + seconds_since(start_); }

  Simulation& simulation_;
  ResultsWriter& results_;
  const RunSceneOptions& options_;
  const Plan& plan_;
  RecorderSetup setup_;
  OutputSchedule schedule_, snapshots_;
  RecentAmplitude amplitude_;
  WallClock::time_point start_;
  Profile profile_; ///< only with options.profile
  double earlier_wall_time_ = 0.0;
  std::int64_t steps_between_looks_ = 1;
  double told_ = 0.0;            ///< s of this part
  double next_checkpoint_ = 0.0; ///< s since the part was begun
  bool checkpoint_due_ = false;
  bool out_of_time_ = false;
};

/// Runs a Recorder to its end and writes the summary, the frequency response or the decay if the run gives one, and the
/// trace if there is a profile.
RunResult record_run(Simulation& simulation, ResultsWriter& results, const RunFolder& files,
                     const RunSceneOptions& options, RecorderSetup setup);

} // namespace grandamp
