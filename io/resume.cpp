#include "io/preparation.hpp"
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

/// The summary in the folder if it tells of a run that is done, else null.
nlohmann::json summary_of_done(const std::filesystem::path& summary) {
  std::ifstream file(summary);
  nlohmann::json told = nlohmann::json::parse(file, nullptr, false);
  const bool done = told.is_object() && told.value("status", nlohmann::json()) == "done";
  return done ? told : nlohmann::json();
}

/// A run that was done before anyone asked to resume it.
RunResult done_before(const std::filesystem::path& summary, std::int64_t steps, double time) {
  RunResult result;
  result.status = RunStatus::done_before;
  result.steps = steps;
  result.time = time;
  std::ifstream file(summary);
  result.summary.assign(std::istreambuf_iterator<char>(file), {});
  result.message = fmt::format("the run is finished, at {:.9g} s; --set time.duration=... goes on further", time);
  return result;
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
  Resumption(RunFolder& files, const std::vector<std::string>& overrides, const RunSceneOptions& options)
      : begun_(WallClock::now()), options_(options), asked_(overrides), files_(files),
        checkpoints_(files.checkpoints()), found_(find_checkpoint(checkpoints_)), name_(files_.scene().string()) {
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
    checkpoints_.newest_is_damaged = found_.newest_is_damaged;
    if (found_.file == checkpoints_.next) checkpoints_.settle();
  }

  RunResult go() {
    const SceneDocument original = read_scene_text(found_.checkpoint.scene, name_);
    const SceneDocument present =
        all_overrides_.empty() ? original : read_scene_text(found_.checkpoint.scene, name_, all_overrides_);
    return found_.checkpoint.recording.pouring ? pour_on(original, present) : go_on(original, present);
  }

private:
  template <class Make> auto with_state(const SceneDocument& original, const Make& make) const {
    try {
      return make();
    } catch (const StateError& error) {
      throw FileError(fmt::format("{}: cannot go on from it by the same bits: {}", found_.file.string(), error.what()));
    } catch (const SceneError& error) {
      throw SceneError(located(original, error.problems()));
    }
  }

  RunResult go_on(const SceneDocument& original, const SceneDocument& present) {
    const Checkpoint& checkpoint = found_.checkpoint;
    Simulation simulation = with_state(original, [&] {
      RunOptions run;
      run.threads = options_.threads;
      run.isa = isa_for(checkpoint, options_.isa);
      return Simulation(original.scene, checkpoint.state, run);
    });
    std::vector<Problem> notes = present.notes;
    if (sets(asked_, "time.duration")) change_duration(simulation, present.scene, notes);
    tell(notes);
    const nlohmann::json done = summary_of_done(files_.summary());
    if (simulation.finished() && done.is_object() && done.value("steps", nlohmann::json()) == simulation.step_number())
      return done_before(files_.summary(), simulation.step_number(), simulation.time());

    files_.forget_summary();
    ResultsWriter results = ResultsWriter::go_on(files_.results(), present.text, simulation.plan().scene.output.energy,
                                                 checkpoint.recording.position, &checkpoint.recording.latest);
    if (!asked_.empty()) replace_file(files_.scene(), present.text);
    RecorderSetup setup = setup_with(present);
    setup.earlier = &checkpoint.recording;
    setup.checkpoint_first = !asked_.empty();
    return record_run(simulation, results, files_, options_, std::move(setup));
  }

  RunResult pour_on(const SceneDocument& original, const SceneDocument& present) {
    const Checkpoint& checkpoint = found_.checkpoint;
    if (!asked_.empty()) replace_file(files_.scene(), present.text);
    RecorderSetup setup = setup_with(present);
    setup.packing_wall_time = checkpoint.recording.packing_wall_time;
    Preparation preparation = with_state(original, [&] {
      return prepare(original, isa_for(checkpoint, options_.isa), files_, options_, setup, &checkpoint);
    });
    if (!preparation.simulation) return preparation.stopped;
    std::vector<Problem> notes = present.notes;
    if (sets(all_overrides_, "time.duration")) change_duration(*preparation.simulation, present.scene, notes);
    tell(notes);
    setup.checkpoint_first = !all_overrides_.empty();
    return record_from_the_start(preparation, present.text, files_, options_, std::move(setup));
  }

  RecorderSetup setup_with(const SceneDocument& present) const {
    return {.output = present.scene.output,
            .checkpoints = checkpoints_,
            .scene_text = found_.checkpoint.scene,
            .overrides = all_overrides_,
            .begun = begun_};
  }

  void tell(const std::vector<Problem>& notes) const {
    if (options_.notes && !notes.empty()) options_.notes(notes);
  }

  WallClock::time_point begun_;
  const RunSceneOptions& options_;
  const std::vector<std::string>& asked_;
  RunFolder& files_;
  CheckpointFiles checkpoints_;
  FoundCheckpoint found_;
  std::string name_;
  std::vector<std::string> all_overrides_;
};

/// A run that was killed before its first checkpoint has lost nothing but that time: it starts anew.
RunResult start_anew(RunFolder& files, const std::vector<std::string>& overrides, const RunSceneOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(files.scene(), error))
    throw FileError(files.scene().parent_path().string() +
                    ": holds no checkpoint, so there is nothing to go on from; start the run anew");
  refuse_changes_of_the_past(overrides);
  if (const nlohmann::json done = summary_of_done(files.summary()); done.is_object()) {
    if (!overrides.empty())
      throw FileError(files.scene().parent_path().string() +
                      ": the run is finished and holds no checkpoint to go on further from");
    return done_before(files.summary(), done.value("steps", std::int64_t{0}), done.value("duration", 0.0));
  }
  const SceneDocument document = read_scene(files.scene(), overrides);
  if (options.warning)
    options.warning(files.scene().parent_path().string() +
                    ": the run was stopped before its first checkpoint, and starts anew");
  files.forget_summary();
  if (!overrides.empty()) replace_file(files.scene(), document.text);
  return run_anew(document, files, options);
}

} // namespace

RunResult resume_run(const std::filesystem::path& folder, const std::vector<std::string>& overrides,
                     const RunSceneOptions& options) {
  RunFolder files = RunFolder::of_run(folder);
  if (!files.checkpoints().any()) return start_anew(files, overrides, options);
  return Resumption(files, overrides, options).go();
}

} // namespace grandamp
