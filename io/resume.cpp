#include "io/recorder.hpp"
#include "io/results.hpp"
#include "io/run.hpp"
#include "io/run_folder.hpp"
#include "io/text_file.hpp"
#include "io/version.hpp"
#include "kernels/dispatch.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

namespace grandamp {
namespace {

constexpr std::array<std::string_view, 4> changeable{"time.duration", "output.history_interval",
                                                     "output.snapshot_interval", "output.checkpoint_interval"};
constexpr const char* changeable_text =
    "time.duration, output.history_interval, output.snapshot_interval, output.checkpoint_interval";

std::string key_of(const std::string& override_text) {
  std::string key = override_text.substr(0, override_text.find('='));
  std::erase_if(key, [](char c) { return c == ' ' || c == '\t'; });
  return key;
}

bool sets(const std::vector<std::string>& overrides, std::string_view key) {
  return std::any_of(overrides.begin(), overrides.end(), [key](const std::string& one) { return key_of(one) == key; });
}

void refuse_changes_of_the_past(const std::vector<std::string>& overrides) {
  for (const std::string& one : overrides) {
    const std::string key = key_of(one);
    if (std::find(changeable.begin(), changeable.end(), key) == changeable.end())
      throw UsageError(fmt::format("--set {}: {} cannot change in a run that goes on: what was simulated already would "
                                   "have been otherwise; allowed: {}",
                                   one, key, changeable_text));
  }
}

/// The kernels to go on with: those of before if they are here, else those with the same bits.
std::string isa_for(const Checkpoint& checkpoint, const std::string& asked) {
  using kernels::InstructionSet;
  const auto fuses = [](InstructionSet set) { return set != InstructionSet::generic; };
  std::string other;
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::generic}) {
    if (!kernels::available(set)) continue;
    std::string name = kernels::name(set);
    if (fuses(set) != checkpoint.state.fused) {
      if (name == asked)
        throw UsageError(
            fmt::format("--isa {}: the run used {}, and these kernels differ in the last bits", asked, checkpoint.isa));
      continue;
    }
    if (name == asked || (asked.empty() && name == checkpoint.isa)) return name;
    if (other.empty()) other = name;
  }
  if (other.empty())
    throw UsageError(fmt::format("the run used {} kernels, which this machine or program has not, and others differ in "
                                 "the last bits; go on with it on a machine like the one before",
                                 checkpoint.isa));
  return other;
}

/// Whether the summary in the folder tells of the run up to this step, done.
bool told_to_the_end(const std::filesystem::path& summary, std::int64_t steps) {
  std::ifstream file(summary);
  const nlohmann::json told = nlohmann::json::parse(file, nullptr, false);
  return told.is_object() && told.value("status", nlohmann::json()) == "done" &&
         told.value("steps", nlohmann::json()) == steps;
}

/// Moves the end of the run to where the scene now says.
void change_duration(Simulation& simulation, const Scene& scene, std::vector<Problem>& notes) {
  const Plan& plan = simulation.plan();
  const double asked = scene.time.duration, step = plan.time_step;
  const auto note = [&notes](std::string key, std::string message) {
    Problem problem;
    problem.key = std::move(key);
    problem.message = std::move(message);
    problem.note = true;
    notes.push_back(std::move(problem));
  };
  const auto steps = static_cast<std::int64_t>(std::llround(asked / step));
  if (steps < simulation.step_number())
    throw UsageError(fmt::format("time.duration = {} s: the run is already at {:.9g} s", asked, simulation.time()));
  const double duration = static_cast<double>(steps) * step;
  if (std::abs(duration - asked) > 1e-9 * asked)
    note("time.duration",
         fmt::format("{} s is no whole number of steps of {:.6g} s; the run ends at {:.9g} s", asked, step, duration));
  std::optional<std::array<double, 2>> window = scene.output.window;
  if (window && (*window)[0] != plan.window[0] && (*window)[0] < simulation.time()) window.reset();
  simulation.end_at(steps, window);
  if (!window && plan.window[0] != 0.5 * duration)
    note("output.window", fmt::format("of the last half only [{:.9g}, {:.9g}] s is left for the statistics",
                                      plan.window[0], plan.window[1]));
}

/// A run's folder, checkpoint and scene, held against what is asked of it.
class Resumption {
public:
  Resumption(const std::filesystem::path& folder, const std::vector<std::string>& overrides,
             const RunSceneOptions& options)
      : begun_(WallClock::now()), options_(options), asked_(overrides), files_(RunFolder::of_run(folder)),
        found_(find_checkpoint(files_.checkpoints())), name_(files_.scene().string()) {
    const Checkpoint& checkpoint = found_.checkpoint;
    if (options.warning)
      for (const std::string& damaged : found_.damaged)
        options.warning(damaged + "; going on from " + found_.file.filename().string());
    if (checkpoint.version != version())
      throw UsageError(fmt::format("{}: written by grandamp {}, and this is {}, whose steps may differ in the last "
                                   "bits; go on with the program of before",
                                   found_.file.string(), checkpoint.version, version()));
    refuse_changes_of_the_past(overrides);
    all_overrides_ = checkpoint.overrides;
    all_overrides_.insert(all_overrides_.end(), overrides.begin(), overrides.end());
  }

  RunResult go() {
    const Checkpoint& checkpoint = found_.checkpoint;
    const SceneDocument original = read_scene_text(checkpoint.scene, name_);
    const SceneDocument present =
        all_overrides_.empty() ? original : read_scene_text(checkpoint.scene, name_, all_overrides_);
    Simulation simulation = restored(original);
    std::vector<Problem> notes = present.notes;
    if (sets(asked_, "time.duration")) change_duration(simulation, present.scene, notes);
    if (options_.notes && !notes.empty()) options_.notes(notes);
    if (simulation.finished() && told_to_the_end(files_.summary(), simulation.step_number())) return done_before();

    ResultsWriter results = ResultsWriter::go_on(files_.results(), present.text, simulation.plan().scene.output.energy,
                                                 checkpoint.recording.position);
    if (!asked_.empty()) replace_file(files_.scene(), present.text);
    return record_run(simulation, results, files_, options_,
                      {.output = present.scene.output,
                       .checkpoints = files_.checkpoints(),
                       .scene_text = checkpoint.scene,
                       .overrides = all_overrides_,
                       .begun = begun_,
                       .earlier = &checkpoint.recording});
  }

private:
  Simulation restored(const SceneDocument& original) const {
    RunOptions run;
    run.threads = options_.threads;
    run.isa = isa_for(found_.checkpoint, options_.isa);
    try {
      return Simulation(original.scene, found_.checkpoint.state, run);
    } catch (const StateError& error) {
      throw FileError(fmt::format("{}: cannot go on from it by the same bits: {}", found_.file.string(), error.what()));
    } catch (const SceneError& error) {
      throw SceneError(located(original, error.problems()));
    }
  }

  RunResult done_before() const {
    const RunState& state = found_.checkpoint.state;
    RunResult result;
    result.status = RunStatus::done_before;
    result.steps = state.step_number;
    result.time = static_cast<double>(state.step_number) * state.time_step;
    std::ifstream summary(files_.summary());
    result.summary.assign(std::istreambuf_iterator<char>(summary), {});
    result.message =
        fmt::format("the run is finished, at {:.9g} s; --set time.duration=... goes on further", result.time);
    return result;
  }

  WallClock::time_point begun_;
  const RunSceneOptions& options_;
  const std::vector<std::string>& asked_;
  RunFolder files_;
  FoundCheckpoint found_;
  std::string name_;
  std::vector<std::string> all_overrides_;
};

} // namespace

RunResult resume_run(const std::filesystem::path& folder, const std::vector<std::string>& overrides,
                     const RunSceneOptions& options) {
  return Resumption(folder, overrides, options).go();
}

} // namespace grandamp
