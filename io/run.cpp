#include "io/run.hpp"

#include "io/output_schedule.hpp"
#include "io/profile_report.hpp"
#include "io/results.hpp"
#include "io/run_folder.hpp"
#include "io/summary.hpp"
#include "io/text_file.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

namespace grandamp {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Thrown out of the pouring, which has no other way to be stopped.
struct Interrupted {};

/// Half the peak-to-peak of the displacement in the last whole period, from history rows: for the progress line only.
class RecentAmplitude {
public:
  explicit RecentAmplitude(const Scene& scene) {
    if (!scene.structure) return;
    period_ = scene.excitation.kind == ExcitationKind::harmonic
                  ? 1.0 / scene.excitation.frequency
                  : 2.0 * std::numbers::pi * std::sqrt(scene.structure->mass / scene.structure->stiffness);
  }

  void add(const Sample& sample) {
    if (!std::isfinite(period_) || period_ <= 0.0) return;
    if (sample.time >= end_) {
      if (low_ <= high_) value_ = 0.5 * (high_ - low_);
      low_ = std::numeric_limits<double>::infinity();
      high_ = -low_;
      end_ = sample.time + period_;
    }
    low_ = std::min(low_, sample.displacement);
    high_ = std::max(high_, sample.displacement);
  }
  std::optional<double> value() const { return value_; }

private:
  double period_ = 0.0;
  double end_ = 0.0;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  std::optional<double> value_;
};

Simulation prepare(const Scene& scene, const RunSceneOptions& options) {
  RunOptions run;
  run.threads = options.threads;
  run.isa = options.isa;
  run.pouring_progress = [&options](double time, double energy) {
    if (options.stop_requested && options.stop_requested()) throw Interrupted{};
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

/// The steps of a run and what is recorded on the way.
class Recorder {
public:
  Recorder(Simulation& simulation, ResultsWriter& results, const RunSceneOptions& options)
      : simulation_(simulation), results_(results), options_(options), plan_(simulation.plan()),
        schedule_(plan_.scene.output.history_interval, plan_.time_step), amplitude_(plan_.scene), start_(Clock::now()) {
    if (plan_.scene.output.snapshot_interval > 0.0)
      snapshots_ = OutputSchedule(plan_.scene.output.snapshot_interval, plan_.time_step);
    // Looking at the clock costs more than a step of a few granules: about once a millisecond is enough.
    const auto granules = static_cast<std::int64_t>(plan_.granules);
    steps_between_looks_ = std::clamp<std::int64_t>(200'000 / std::max<std::int64_t>(granules, 1), 1, 1000);
    record.plan = &plan_;
    record.isa = simulation.isa();
    record.threads = simulation.threads();
    record.initial = record.end = simulation.sample();
    if (options.profile) record.profile = &profile_;
    simulation.set_profile(options.profile ? &profile_ : nullptr);
  }

  void go() {
    try {
      step_to_the_end();
      record.end = simulation_.sample();
      if (schedule_.due(simulation_.step_number())) keep(record.end);
      take_snapshot_if_due();
      results_.write_final(simulation_.granules(), simulation_.time());
    } catch (const GuardError& error) {
      // The state is no longer to be trusted, so what was recorded before is all there is.
      record.status = RunStatus::stopped_by_guard;
      record.message = error.what();
    }
    record.steps = simulation_.step_number();
    record.time = simulation_.time();
    record.verlet = simulation_.verlet();
    record.guards = simulation_.guards();
    record.response = simulation_.response();
    timed(profile(), Phase::output, 0, [&] { results_.close(); });
    record.wall_time = seconds_since(start_);
    tell_warnings();
    tell_progress(record.wall_time);
  }

  RunRecord record;

private:
  void step_to_the_end() {
    std::int64_t next_look = 0;
    while (!simulation_.finished()) {
      if (options_.stop_requested && options_.stop_requested()) {
        record.status = RunStatus::interrupted;
        record.message = "interrupted; there is no checkpoint to go on from in this version";
        return;
      }
      take_snapshot_if_due();
      if (schedule_.due(simulation_.step_number())) {
        keep(simulation_.step_and_sample());
      } else {
        simulation_.step();
      }
      if (simulation_.step_number() >= next_look) {
        look_at_the_clock();
        next_look = simulation_.step_number() + steps_between_looks_;
      }
    }
  }

  void keep(const Sample& sample) {
    record.end = sample;
    timed(profile(), Phase::output, 0, [&] { results_.append(sample); });
    amplitude_.add(sample);
    schedule_.advance();
  }

  void take_snapshot_if_due() {
    if (!snapshots_.due(simulation_.step_number())) return;
    timed(profile(), Phase::output, 0, [&] { results_.append_snapshot(simulation_.granules(), simulation_.time()); });
    snapshots_.advance();
  }

  void look_at_the_clock() {
    const double now = seconds_since(start_);
    if (now - told_ >= 0.1) {
      told_ = now;
      tell_warnings();
      tell_progress(now);
    }
    timed(profile(), Phase::output, 0, [&] { results_.fold_if_due(); });
  }

  Profile* profile() { return options_.profile ? &profile_ : nullptr; }

  void tell_warnings() {
    const std::vector<std::string> warnings = simulation_.take_warnings();
    if (!options_.warning) return;
    for (const std::string& warning : warnings) options_.warning(warning);
  }

  void tell_progress(double now) {
    if (!options_.progress) return;
    const double granule_steps = static_cast<double>(plan_.granules) * static_cast<double>(simulation_.step_number());
    RunProgress progress;
    progress.time = simulation_.time();
    progress.duration = plan_.time_step * static_cast<double>(plan_.steps);
    progress.wall_time = now;
    progress.rate = now > 0.0 ? granule_steps / now : 0.0;
    progress.amplitude = amplitude_.value();
    options_.progress(progress);
  }

  Simulation& simulation_;
  ResultsWriter& results_;
  const RunSceneOptions& options_;
  const Plan& plan_;
  OutputSchedule schedule_, snapshots_;
  RecentAmplitude amplitude_;
  Clock::time_point start_;
  Profile profile_; ///< only with options.profile
  std::int64_t steps_between_looks_ = 1;
  double told_ = 0.0;
};

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
  const Clock::time_point start = Clock::now();
  std::optional<Simulation> prepared;
  try {
    prepared = with_lines(document, [&] { return prepare(document.scene, options); });
  } catch (const Interrupted&) {
    files.abandon();
    result.status = RunStatus::interrupted;
    result.message = "interrupted while the granules were poured; there is nothing to keep";
    return result;
  } catch (...) {
    files.abandon();
    throw;
  }
  Simulation& simulation = *prepared;
  const double packing_wall_time = seconds_since(start);

  files.begin(document.text);
  ResultsWriter results(files.results(), document.text, simulation.plan().scene.output.energy);
  Recorder recorder(simulation, results, options);
  recorder.record.packing_wall_time = packing_wall_time;
  recorder.go();

  result.status = recorder.record.status;
  result.message = recorder.record.message;
  result.steps = recorder.record.steps;
  result.time = recorder.record.time;
  if (simulation.plan().scene.structure) result.response = recorder.record.response;
  result.summary = summary_text(recorder.record);
  replace_file(files.summary(), result.summary);
  if (options.profile) replace_file(files.trace(), trace_text(*recorder.record.profile));
  return result;
}

} // namespace grandamp
