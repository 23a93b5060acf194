#include "io/recorder.hpp"

#include "io/decay_files.hpp"
#include "io/profile_report.hpp"
#include "io/run_response.hpp"
#include "io/text_file.hpp"
#include "io/version.hpp"
#include "solver/several_modes.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace grandamp {

double seconds_since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

RecentAmplitude::RecentAmplitude(const Scene& scene) {
  if (!scene.structure) return;
  const Oscillator own = fastest_oscillator(*scene.structure);
  const ExcitationKind kind = scene.excitation.kind;
  period_ = kind == ExcitationKind::harmonic || kind == ExcitationKind::base
                ? 1.0 / scene.excitation.frequency
                : 2.0 * std::numbers::pi * std::sqrt(own.mass / own.stiffness);
}

void RecentAmplitude::add(const Sample& sample) {
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

Recorder::Recorder(Simulation& simulation, ResultsWriter& results, const RunSceneOptions& options, RecorderSetup setup)
    : simulation_(simulation), results_(results), options_(options), plan_(simulation.plan()), setup_(std::move(setup)),
      schedule_(setup_.output.history_interval, plan_.time_step, simulation.step_number()), amplitude_(plan_.scene),
      start_(WallClock::now()) {
  if (setup_.output.snapshot_interval > 0.0)
    snapshots_ = OutputSchedule(setup_.output.snapshot_interval, plan_.time_step, simulation.step_number());
  // Looking at the clock costs more than a step of a few granules: about once a millisecond is enough.
  const auto granules = static_cast<std::int64_t>(plan_.granules);
  steps_between_looks_ = std::clamp<std::int64_t>(200'000 / std::max<std::int64_t>(granules, 1), 1, 1000);
  next_checkpoint_ = setup_.output.checkpoint_interval;
  checkpoint_due_ = setup_.checkpoint_first;
  record.plan = &plan_;
  record.isa = simulation.isa();
  record.threads = simulation.threads();
  if (const RecordingState* earlier = setup_.earlier) {
    record.initial = earlier->initial;
    record.end = earlier->latest;
    record.packing_wall_time = earlier->packing_wall_time;
    earlier_wall_time_ = earlier->wall_time;
  } else {
    record.initial = record.end = simulation.sample();
    record.packing_wall_time = setup_.packing_wall_time;
  }
  record.profile = profile();
  simulation.set_profile(profile());
}

void Recorder::go() {
  try {
    step_to_the_end();
    // Before the end is recorded: whoever goes on further from here has then nothing to take back.
    if (record.status == RunStatus::done && (setup_.output.checkpoint_interval > 0.0 || setup_.checkpoints.any()))
      write_checkpoint_now();
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
  record.step_review = simulation_.step_review();
  record.response = simulation_.response();
  timed(profile(), Phase::output, 0, [&] { results_.close(); });
  record.wall_time = wall_time();
  tell_warnings();
  tell_progress();
}

void Recorder::step_to_the_end() {
  std::int64_t next_look = 0;
  while (!simulation_.finished()) {
    switch (wish()) {
    case Wish::stop:
      write_checkpoint_now();
      return;
    case Wish::checkpoint:
      write_checkpoint_now();
      break;
    case Wish::none:
      break;
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

Recorder::Wish Recorder::wish() {
  if (options_.stop_requested && options_.stop_requested()) {
    stop("interrupted");
    return Wish::stop;
  }
  if (out_of_time_) {
    stop(fmt::format("{:g} s of wall time are over", options_.max_wall));
    return Wish::stop;
  }
  const bool asked = options_.checkpoint_requested && options_.checkpoint_requested();
  return std::exchange(checkpoint_due_, false) || asked ? Wish::checkpoint : Wish::none;
}

void Recorder::stop(std::string why) {
  record.status = RunStatus::interrupted;
  record.message = fmt::format("{} at t = {:.6g} s; go on with: grandamp resume {}", why, simulation_.time(),
                               setup_.checkpoints.newest.parent_path().string());
}

void Recorder::write_checkpoint_now() {
  timed(profile(), Phase::output, 0, [&] {
    results_.sync(); // a checkpoint must not remember what the disk does not hold
    write_checkpoint(setup_.checkpoints, checkpoint());
  });
  next_checkpoint_ = seconds_since(setup_.begun) + setup_.output.checkpoint_interval;
}

Checkpoint Recorder::checkpoint() const {
  Checkpoint checkpoint;
  checkpoint.version = version();
  checkpoint.isa = simulation_.isa();
  checkpoint.scene = setup_.scene_text;
  checkpoint.overrides = setup_.overrides;
  checkpoint.state = simulation_.state();
  checkpoint.recording.position = results_.position();
  checkpoint.recording.initial = record.initial;
  checkpoint.recording.latest = record.end;
  checkpoint.recording.wall_time = wall_time();
  checkpoint.recording.packing_wall_time = record.packing_wall_time;
  return checkpoint;
}

void Recorder::keep(const Sample& sample) {
  record.end = sample;
  timed(profile(), Phase::output, 0, [&] { results_.append(sample); });
  amplitude_.add(sample);
  schedule_.advance();
}

void Recorder::take_snapshot_if_due() {
  if (!snapshots_.due(simulation_.step_number())) return;
  timed(profile(), Phase::output, 0, [&] { results_.append_snapshot(simulation_.granules(), simulation_.time()); });
  snapshots_.advance();
}

void Recorder::look_at_the_clock() {
  const double now = seconds_since(start_);
  if (now - told_ >= 0.1) {
    told_ = now;
    tell_warnings();
    tell_progress();
  }
  timed(profile(), Phase::output, 0, [&] { results_.fold_if_due([this] { return asked_for_something(); }); });
  const double since_begun = seconds_since(setup_.begun);
  checkpoint_due_ |= setup_.output.checkpoint_interval > 0.0 && since_begun >= next_checkpoint_;
  out_of_time_ = options_.max_wall > 0.0 && since_begun >= options_.max_wall;
}

bool Recorder::asked_for_something() {
  if (options_.stop_requested && options_.stop_requested()) return true;
  checkpoint_due_ |= options_.checkpoint_requested && options_.checkpoint_requested();
  return checkpoint_due_;
}

void Recorder::tell_warnings() {
  const std::vector<std::string> warnings = simulation_.take_warnings();
  if (!options_.warning) return;
  for (const std::string& warning : warnings) options_.warning(warning);
}

void Recorder::tell_progress() {
  if (!options_.progress) return;
  const double granule_steps = static_cast<double>(plan_.granules) * static_cast<double>(simulation_.step_number());
  RunProgress progress;
  progress.time = simulation_.time();
  progress.duration = plan_.time_step * static_cast<double>(plan_.steps);
  progress.wall_time = wall_time();
  progress.rate = progress.wall_time > 0.0 ? granule_steps / progress.wall_time : 0.0;
  progress.amplitude = amplitude_.value();
  options_.progress(progress);
}

namespace {

/// Of a run that was driven over a band. What stands in the way of it does not make the run a failure: it is told, and
/// stands in the summary.
std::optional<FrequencyResponse> response_of(RunRecord& record, const RunFolder& files,
                                             const RunSceneOptions& options) {
  const Scene& scene = record.plan->scene;
  if (record.status != RunStatus::done || !gives_response(scene)) return std::nullopt;
  try {
    FrequencyResponse response = run_response(scene, read_history(files.results(), response_columns));
    for (const std::string& note : response.notes)
      if (options.warning) options.warning("frequency response: " + note);
    return response;
  } catch (const UsageError& error) {
    record.no_frequency_response = error.what();
    if (options.warning) options.warning(error.what());
    return std::nullopt;
  }
}

/// After the summary: a disk that is full by now does not cost the run that.
void write_response_files(const RunRecord& record, const RunFolder& files) {
  const Scene& scene = record.plan->scene;
  if (record.frequency_response != nullptr)
    for (const char* name : {"response.csv", "response.unv", "response.svg"})
      write_response(*record.frequency_response, scene, files.file(name), std::time(nullptr));
  const std::vector<VibrationCycle>& cycles = record.response.cycles;
  if (record.status != RunStatus::done || scene.excitation.kind != ExcitationKind::none || cycles.empty()) return;
  replace_file(files.file("decay.csv"), decay_csv(cycles));
  replace_file(files.file("decay.svg"), decay_svg(cycles, scene.title, scene.structure.value_or(Structure{})));
}

} // namespace

RunResult record_run(Simulation& simulation, ResultsWriter& results, const RunFolder& files,
                     const RunSceneOptions& options, RecorderSetup setup) {
  Recorder recorder(simulation, results, options, std::move(setup));
  recorder.go();
  RunRecord& record = recorder.record;
  const std::optional<FrequencyResponse> response = response_of(record, files, options);
  if (response) record.frequency_response = &*response;
  RunResult result;
  result.status = record.status;
  result.message = record.message;
  result.steps = record.steps;
  result.time = record.time;
  if (simulation.plan().scene.structure) result.response = record.response;
  result.summary = summary_text(record);
  replace_file(files.summary(), result.summary);
  write_response_files(record, files);
  if (record.profile != nullptr) replace_file(files.trace(), trace_text(*record.profile));
  return result;
}

} // namespace grandamp
