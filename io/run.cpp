#include "io/run.hpp"

#include "io/recorder.hpp"
#include "io/results.hpp"
#include "io/run_folder.hpp"

#include <optional>

namespace grandamp {
namespace {

/// Thrown out of the pouring, which has no other way to be stopped.
struct Interrupted {};

Simulation prepare(const Scene& scene, const RunSceneOptions& options, WallClock::time_point begun) {
  RunOptions run;
  run.threads = options.threads;
  run.isa = options.isa;
  run.pouring_progress = [&options, begun](double time, double energy) {
    const bool over = options.max_wall > 0.0 && seconds_since(begun) >= options.max_wall;
    if (over || (options.stop_requested && options.stop_requested())) throw Interrupted{};
    if (!options.progress) return;
    RunProgress progress;
    progress.pouring = true;
    progress.pouring_energy = energy;
    progress.time = time;
    options.progress(progress);
  };
  return Simulation(scene, run);
}

/// Faults found by the solver carry keys alone: adds the document's lines.
template <class Work> auto with_lines(const SceneDocument& document, const Work& work) {
  try {
    return work();
  } catch (const SceneError& error) {
    throw SceneError(located(document, error.problems()));
  }
}

} // namespace

Plan make_located_plan(const SceneDocument& document) {
  Plan plan = with_lines(document, [&] { return make_plan(document.scene); });
  plan.notes = located(document, std::move(plan.notes));
  plan.notes.insert(plan.notes.begin(), document.notes.begin(), document.notes.end());
  return plan;
}

RunResult run_scene(const SceneDocument& document, const std::filesystem::path& folder,
                    const RunSceneOptions& options) {
  const std::vector<Problem> notes = make_located_plan(document).notes; // a bad scene must not cost the folder anything
  if (options.notes && !notes.empty()) options.notes(notes);
  RunFolder files(folder, options.force);
  RunResult result;
  const WallClock::time_point begun = WallClock::now();
  std::optional<Simulation> prepared;
  try {
    prepared = with_lines(document, [&] { return prepare(document.scene, options, begun); });
  } catch (const Interrupted&) {
    files.abandon();
    result.status = RunStatus::interrupted;
    result.message =
        "interrupted while the granules were poured: there is nothing to go on from yet; run the scene again";
    return result;
  } catch (...) {
    files.abandon();
    throw;
  }
  Simulation& simulation = *prepared;
  const double packing_wall_time = seconds_since(begun);

  files.begin(document.text);
  ResultsWriter results(files.results(), document.text, simulation.plan().scene.output.energy);
  return record_run(simulation, results, files, options,
                    {.output = document.scene.output,
                     .checkpoints = files.checkpoints(),
                     .scene_text = document.text,
                     .overrides = {},
                     .begun = begun,
                     .packing_wall_time = packing_wall_time});
}

} // namespace grandamp
