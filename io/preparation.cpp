#include "io/preparation.hpp"

#include "io/results.hpp"
#include "io/version.hpp"
#include "kernels/dispatch.hpp"

#include <fmt/format.h>

#include <utility>

namespace grandamp {
namespace {

/// Thrown out of the packing, which has no other way to be stopped.
struct Stopped {
  std::string message;
};

/// Looks after signals, the clock and checkpoints while granules are placed and poured.
class PouringWatch {
public:
  PouringWatch(RunFolder& files, const std::string& isa, const RunSceneOptions& options, const RecorderSetup& setup)
      : files_(files), checkpoints_(setup.checkpoints),
        isa_(isa.empty() ? kernels::name(kernels::best_available()) : isa), options_(options), setup_(setup),
        next_checkpoint_(setup.output.checkpoint_interval) {}

  void look(const PouringProgress& now) {
    const double wall_time = seconds_since(setup_.begun);
    const bool over = options_.max_wall > 0.0 && wall_time >= options_.max_wall;
    if (over || (options_.stop_requested && options_.stop_requested())) stop(now, over);
    const bool asked = options_.checkpoint_requested && options_.checkpoint_requested();
    const bool due = setup_.output.checkpoint_interval > 0.0 && wall_time >= next_checkpoint_;
    if (now.save && (asked || due)) {
      save(now);
      next_checkpoint_ = seconds_since(setup_.begun) + setup_.output.checkpoint_interval;
    }
    if (options_.progress && now.save && wall_time - told_ >= 0.1) {
      told_ = wall_time;
      RunProgress progress;
      progress.pouring = true;
      progress.pouring_energy = now.energy;
      progress.time = now.time;
      options_.progress(progress);
    }
  }

private:
  [[noreturn]] void stop(const PouringProgress& now, bool over) {
    std::string why = over ? fmt::format("{:g} s of wall time are over", options_.max_wall) : "interrupted";
    if (!now.save) throw Stopped{why + " while places for the granules were sought: run the scene again"};
    save(now);
    throw Stopped{fmt::format("{} while the granules were poured, at {:.6g} s; go on with: grandamp resume {}", why,
                              now.time, checkpoints_.newest.parent_path().string())};
  }

  void save(const PouringProgress& now) {
    files_.begin(setup_.scene_text);
    Checkpoint checkpoint;
    checkpoint.version = version();
    checkpoint.isa = isa_;
    checkpoint.scene = setup_.scene_text;
    checkpoint.overrides = setup_.overrides;
    now.save(checkpoint.state);
    checkpoint.recording.pouring = true;
    checkpoint.recording.packing_wall_time = setup_.packing_wall_time + seconds_since(setup_.begun);
    write_checkpoint(checkpoints_, checkpoint);
  }

  RunFolder& files_;
  CheckpointFiles checkpoints_;
  std::string isa_;
  const RunSceneOptions& options_;
  const RecorderSetup& setup_;
  double next_checkpoint_;
  double told_ = 0.0;
};

} // namespace

Preparation prepare(const SceneDocument& document, const std::string& isa, RunFolder& files,
                    const RunSceneOptions& options, const RecorderSetup& setup, const Checkpoint* so_far) {
  PouringWatch watch(files, isa, options, setup);
  RunOptions run;
  run.threads = options.threads;
  run.isa = isa;
  run.pouring_progress = [&watch](const PouringProgress& now) { watch.look(now); };
  run.poured_so_far = so_far != nullptr ? &so_far->state : nullptr;
  Preparation preparation;
  try {
    preparation.simulation.emplace(document.scene, run);
  } catch (const Stopped& stopped) {
    files.abandon();
    preparation.stopped.status = RunStatus::interrupted;
    preparation.stopped.message = stopped.message;
  } catch (const SceneError& error) {
    files.abandon();
    throw SceneError(located(document, error.problems())); // the solver's carry keys alone: the document's lines
  } catch (...) {
    files.abandon();
    throw;
  }
  preparation.wall_time = setup.packing_wall_time + seconds_since(setup.begun);
  return preparation;
}

RunResult record_from_the_start(Preparation& preparation, const std::string& text, RunFolder& files,
                                const RunSceneOptions& options, RecorderSetup setup) {
  Simulation& simulation = *preparation.simulation;
  files.begin(text);
  setup.packing_wall_time = preparation.wall_time;
  ResultsWriter results(files.results(), text, simulation.plan().scene.output.energy);
  return record_run(simulation, results, files, options, std::move(setup));
}

RunResult run_anew(const SceneDocument& document, RunFolder& files, const RunSceneOptions& options) {
  RecorderSetup setup{.output = document.scene.output,
                      .checkpoints = files.checkpoints(),
                      .scene_text = document.text,
                      .overrides = {},
                      .begun = WallClock::now()};
  Preparation preparation = prepare(document, options.isa, files, options, setup);
  if (!preparation.simulation) return preparation.stopped;
  return record_from_the_start(preparation, document.text, files, options, std::move(setup));
}

} // namespace grandamp
