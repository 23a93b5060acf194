// Runs cut and resumed in this program: the same results, and what may and may not change on the way.
#include "io/checkpoint.hpp"
#include "io/version.hpp"
#include "kernels/dispatch.hpp"
#include "tests/exactness/exactness_support.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scene_texts.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace grandamp;
using namespace grandamp::test;

namespace {

SceneDocument scene_of(const std::string& text) {
  return read_scene_text(text, "small.toml");
}

/// A little over 10,000 steps, with snapshots and a window of its own.
std::string eight_granules() {
  return replaced(small_scene(), "history_interval = 1.0e-3",
                  "history_interval = 1.3e-4\nsnapshot_interval = 4.0e-3\nwindow = [0.011, 0.043]");
}

} // namespace

TEST_CASE("a run cut at random steps and resumed has the results of one never cut") {
  const TemporaryFolder folder;
  const SceneDocument document = scene_of(eight_granules());
  run_scene(document, folder / "whole", threads(1));
  const Outcomes whole = outcomes_of(folder / "whole");
  CHECK(whole.history.columns.front().size() == 385);

  std::mt19937 random(7);
  const int runs = full_tests() ? 20 : 3;
  for (int run = 0; run < runs; ++run) {
    std::uniform_int_distribution<std::int64_t> some(0, run == 0 ? 150 : 2500);
    const std::filesystem::path cut = folder / ("cut" + std::to_string(run));
    RunResult result = run_scene(document, cut, stopping_after(some(random)));
    int parts = 1;
    for (; result.status == RunStatus::interrupted && parts < 500; ++parts)
      result = resume_run(cut, {}, stopping_after(some(random), 1 + parts % 2));
    REQUIRE(result.status == RunStatus::done);
    CHECK(parts > (run == 0 ? 90 : 2));
    check_same(outcomes_of(cut), whole);
    CHECK(read_snapshot_near(cut / "results.h5", 0.021)->table.position ==
          read_snapshot_near(folder / "whole/results.h5", 0.021)->table.position);
    std::vector<std::string> files = files_in(cut);
    std::erase_if(files, [](const std::string& name) { return name == "snapshots.xdmf"; });
    CHECK(files == files_of_a_run);
  }
}

TEST_CASE("mixed precision: cut and resumed, and with other output, the same bits") {
  const TemporaryFolder folder;
  const std::vector<std::string> mixed{"time.precision=mixed"};
  const SceneDocument document = read_scene_text(small_scene(), "small.toml", mixed);
  run_scene(document, folder / "whole", threads(1));
  RunResult result = run_scene(document, folder / "cut", stopping_after(1237));
  while (result.status == RunStatus::interrupted) result = resume_run(folder / "cut", {}, stopping_after(3001));
  REQUIRE(result.status == RunStatus::done);
  check_same(outcomes_of(folder / "cut"), outcomes_of(folder / "whole"));
  CHECK(nlohmann::json::parse(content_of(folder / "cut/summary.json"))["precision"] == "mixed");
  for (const char* other : {"output.energy=false", "output.history_interval=7e-6"}) {
    const std::filesystem::path run = folder / other;
    run_scene(read_scene_text(small_scene(), "small.toml", {mixed.front(), other}), run, threads(1));
    check_same_granules(read_final_granules(run / "results.h5"), read_final_granules(folder / "whole/results.h5"));
  }
}

TEST_CASE("a finished run says so, and --set time.duration goes on as if it had been meant so from the start") {
  const TemporaryFolder folder;
  // Durations that are whole numbers of a step without rounding, a window that both have, and a closing speed given: an
  // estimate looks at the whole duration, and a run that goes on keeps the one that its step was chosen by.
  const std::string text =
      replaced(replaced(small_scene(), "step = 5.0e-6", "step = 7.62939453125e-06\nimpact_speed = 1.5"),
               "history_interval = 1.0e-3", "history_interval = 1.0e-3\nwindow = [0.01, 0.03]");
  const std::string longer = replaced(text, "duration = 0.05", "duration = 0.0625");
  run_scene(scene_of(longer), folder / "whole", threads(1));
  run_scene(scene_of(replaced(text, "duration = 0.05", "duration = 0.03125")), folder / "run", threads(1));

  const std::string before = content_of(folder / "run/summary.json");
  const RunResult again = resume_run(folder / "run", {}, threads(1));
  CHECK(again.status == RunStatus::done_before);
  CHECK(contains(again.message, "finished"));
  CHECK(again.summary == before);
  CHECK(content_of(folder / "run/summary.json") == before);

  REQUIRE(resume_run(folder / "run", {"time.duration=0.0546875"}, stopping_after(1000)).status ==
          RunStatus::interrupted);
  REQUIRE(resume_run(folder / "run", {}, stopping_after(1000)).status == RunStatus::interrupted);
  REQUIRE(resume_run(folder / "run", {}, threads(1)).status == RunStatus::done);
  CHECK(resume_run(folder / "run", {}, threads(1)).status == RunStatus::done_before);
  REQUIRE(resume_run(folder / "run", {"time.duration=0.0625"}, threads(1)).status == RunStatus::done);
  check_same(outcomes_of(folder / "run"), outcomes_of(folder / "whole"));
  CHECK(contains(content_of(folder / "run/scene.toml"), "duration = 0.0625"));
}

TEST_CASE("a duration that is no whole number of steps is rounded, and said, and one in the past is refused") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "run", stopping_after(2000));
  std::vector<Problem> notes;
  RunSceneOptions options = threads(1);
  options.notes = [&notes](const std::vector<Problem>& told) { notes = told; };
  CHECK_THROWS_WITH_AS(resume_run(folder / "run", {"time.duration=0.00999"}, options),
                       doctest::Contains("time.duration"), UsageError);
  const RunResult result = resume_run(folder / "run", {"time.duration=0.0200021"}, options);
  CHECK(result.steps == 4000);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].key == "time.duration");
  CHECK(contains(notes[0].message, "0.02 s"));
  const auto summary = nlohmann::json::parse(content_of(folder / "run/summary.json"));
  CHECK(summary["structure"]["window"] == nlohmann::json({0.01, 0.02}));
}

TEST_CASE("output intervals may change for the time to come, and the granules move by the same bits") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "whole", threads(1));
  run_scene(scene_of(small_scene()), folder / "run", stopping_after(5000));
  resume_run(folder / "run",
             {"output.history_interval=2e-3", "output.snapshot_interval=5e-3", "output.checkpoint_interval=1e-3"},
             threads(1));
  check_same_granules(read_final_granules(folder / "run/results.h5"), read_final_granules(folder / "whole/results.h5"));
  const History history = read_history(folder / "run/results.h5");
  CHECK(history.columns.front().size() == 25 + 13); // until 25 ms every 1 ms; from 26 ms on every 2 ms
  CHECK(read_snapshot_near(folder / "run/results.h5", 0.031)->time == doctest::Approx(0.03));
}

TEST_CASE("a change that would alter the past is refused with its key") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "run", stopping_after(500));
  for (const std::string key : {"time.step", "granules.0.count", "contact.granule.friction", "seed", "verlet.policy",
                                "structure.mass", "output.energy", "time.integrator", "time.precision", "colour"}) {
    CAPTURE(key);
    CHECK_THROWS_WITH_AS(resume_run(folder / "run", {key + "=1"}, threads(1)), doctest::Contains(key.c_str()),
                         UsageError);
  }
  CHECK_THROWS_AS(resume_run(folder / "run", {"time.duration=often"}, threads(1)), SceneError);
  CHECK(resume_run(folder / "run", {}, threads(1)).status == RunStatus::done);
}

TEST_CASE("instruction sets: other bits are refused, the same bits go on") {
  using kernels::InstructionSet;
  const TemporaryFolder folder;
  const SceneDocument document = scene_of(small_scene());
  const auto with_isa = [](RunSceneOptions options, const std::string& isa) {
    options.isa = isa;
    return options;
  };
  run_scene(document, folder / "generic", with_isa(threads(1), "generic"));
  run_scene(document, folder / "run", with_isa(stopping_after(3000), "generic"));
  if (kernels::available(InstructionSet::avx2)) {
    CHECK_THROWS_WITH_AS(resume_run(folder / "run", {}, with_isa(threads(1), "avx2")), doctest::Contains("--isa avx2"),
                         UsageError);
    run_scene(document, folder / "whole", with_isa(threads(1), "avx2"));
    run_scene(document, folder / "fused", with_isa(stopping_after(3000), "avx2"));
    CHECK_THROWS_WITH_AS(resume_run(folder / "fused", {}, with_isa(threads(1), "generic")),
                         doctest::Contains("--isa generic"), UsageError);
    const bool wide = kernels::available(InstructionSet::avx512);
    resume_run(folder / "fused", {}, with_isa(threads(1), wide ? "avx512" : "avx2"));
    check_same_granules(read_final_granules(folder / "fused/results.h5"),
                        read_final_granules(folder / "whole/results.h5"));
  }
  resume_run(folder / "run", {}, threads(1)); // generic by itself
  check_same(outcomes_of(folder / "run"), outcomes_of(folder / "generic"));
}

TEST_CASE("another program's checkpoint, or another scene's, is refused plainly") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "run", stopping_after(500));
  CheckpointFiles files(folder / "run");
  const Checkpoint good = read_checkpoint(files.newest);
  CHECK(good.version == version());
  Checkpoint bad = good;
  bad.version = "0.0.1";
  write_checkpoint(files, bad);
  CHECK_THROWS_WITH_AS(resume_run(folder / "run", {}, threads(1)), doctest::Contains("grandamp 0.0.1"), UsageError);
  bad = good;
  bad.state.constants[20] = std::nextafter(bad.state.constants[20], 1.0);
  write_checkpoint(files, bad);
  CHECK_THROWS_WITH_AS(resume_run(folder / "run", {}, threads(1)), doctest::Contains("constants"), FileError);
  bad = good;
  bad.state.list.pairs.push_back(3);
  write_checkpoint(files, bad);
  CHECK_THROWS_WITH_AS(resume_run(folder / "run", {}, threads(1)), doctest::Contains("list/pairs"), FileError);
  write_checkpoint(files, good);
  CHECK(resume_run(folder / "run", {}, threads(1)).status == RunStatus::done);
}

TEST_CASE("output changes nothing: the granules move by the same bits") {
  const TemporaryFolder folder;
  const SceneDocument plain = scene_of(small_scene());
  run_scene(plain, folder / "plain", threads(1));
  const Snapshot expected = read_final_granules(folder / "plain/results.h5");
  int number = 0;
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {"output.history_interval=7e-6"},
           {"output.history_interval=0.05"},
           {"output.energy=false"},
           {"verlet.audit=7"},
           {"output.checkpoint_interval=0"},
           {"output.checkpoint_interval=1e-4"},
           {"output.snapshot_interval=3.1e-4"},
           {"output.window=[0.001,0.002]"},
           {"output.energy=false", "verlet.audit=1", "output.checkpoint_interval=2e-3", "output.snapshot_interval=1e-3",
            "output.history_interval=3e-5"}}) {
    CAPTURE(overrides.front());
    const std::filesystem::path run = folder / std::to_string(number++);
    RunSceneOptions options = threads(1 + number % 2);
    options.profile = number % 3 == 0;
    run_scene(read_scene_text(small_scene(), "small.toml", overrides), run, options);
    check_same_granules(read_final_granules(run / "results.h5"), expected);
  }
}

TEST_CASE("the end of a run that was killed between its last checkpoint and its summary is told by resume") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "whole", threads(1));
  run_scene(scene_of(small_scene()), folder / "run", threads(1));
  std::filesystem::remove(folder / "run/summary.json");
  CHECK(resume_run(folder / "run", {}, threads(1)).status == RunStatus::done);
  check_same(outcomes_of(folder / "run"), outcomes_of(folder / "whole"));
}

TEST_CASE("a folder in use by another program is refused") {
  const TemporaryFolder folder;
  bool refused = false;
  RunSceneOptions options = threads(1);
  options.stop_requested = [&] {
    if (!refused) {
      CHECK_THROWS_WITH_AS(resume_run(folder / "run", {}, threads(1)), doctest::Contains("running in this folder"),
                           UsageError);
      refused = true;
    }
    return false;
  };
  run_scene(scene_of(small_scene()), folder / "run", options);
  CHECK(refused);
}

TEST_CASE("nothing to go on from: no folder and no run") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(resume_run(folder / "none", {}, threads(1)), doctest::Contains("no such folder"), FileError);
  std::filesystem::create_directory(folder / "empty");
  CHECK_THROWS_WITH_AS(resume_run(folder / "empty", {}, threads(1)), doctest::Contains("no checkpoint"), FileError);
}

TEST_CASE("a run without checkpoints: finished it says so, killed it starts anew") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "whole", threads(1));
  run_scene(read_scene_text(small_scene(), "small.toml", {"output.checkpoint_interval=0"}), folder / "run", threads(1));
  CHECK_FALSE(std::filesystem::exists(folder / "run/checkpoint.h5"));
  CHECK(resume_run(folder / "run", {}, threads(1)).status == RunStatus::done_before);
  CHECK_THROWS_WITH_AS(resume_run(folder / "run", {"time.duration=0.06"}, threads(1)),
                       doctest::Contains("no checkpoint to go on further from"), FileError);
  std::filesystem::remove(folder / "run/summary.json");
  write_content(folder / "run/results.h5.new", "what a kill leaves");
  std::string warned;
  RunSceneOptions options = threads(1);
  options.warning = [&warned](const std::string& warning) { warned += warning; };
  CHECK(resume_run(folder / "run", {}, options).status == RunStatus::done);
  CHECK(contains(warned, "before its first checkpoint, and starts anew"));
  check_same(outcomes_of(folder / "run"), outcomes_of(folder / "whole"));
  CHECK(files_in(folder / "run") == std::vector<std::string>{"results.h5", "scene.toml", "summary.json"});
}

TEST_CASE("a finished run that goes on further and is killed at once is not called finished") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "run", threads(1));
  struct Killed {};
  for (const bool asked_again : {false, true}) {
    RunSceneOptions options = threads(1);
    // The first asks for a checkpoint of what was asked are answered, then it is as if the power went.
    options.stop_requested = [steps = 0]() mutable -> bool { return ++steps > 3 ? throw Killed{} : false; };
    CHECK_THROWS_AS(resume_run(folder / "run", {asked_again ? "time.duration=0.06" : "time.duration=0.055"}, options),
                    Killed);
    CHECK_FALSE(std::filesystem::exists(folder / "run/summary.json"));
  }
  const RunResult result = resume_run(folder / "run", {}, threads(1));
  CHECK(result.status == RunStatus::done);
  CHECK(result.steps == 12000); // 0.06 s, though nobody said so again
  CHECK(read_final_granules(folder / "run/results.h5").time == doctest::Approx(0.06));
}

TEST_CASE("checkpoints and results of different runs are not mixed") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "run", stopping_after(3000));
  run_scene(scene_of(replaced(small_scene(), "seed = 3", "seed = 4")), folder / "other", stopping_after(2000));
  std::filesystem::copy_file(folder / "other/checkpoint.h5", folder / "run/checkpoint.h5",
                             std::filesystem::copy_options::overwrite_existing);
  CHECK_THROWS_WITH_AS(resume_run(folder / "run", {}, threads(1)), doctest::Contains("of different runs"), FileError);
}

TEST_CASE("a damaged checkpoint does not take the place of its whole predecessor") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "whole", threads(1));
  run_scene(scene_of(small_scene()), folder / "run", stopping_after(2000));
  resume_run(folder / "run", {}, stopping_after(2000));
  CheckpointFiles files(folder / "run");
  std::string damaged = content_of(files.newest);
  damaged[damaged.size() / 2] ^= 4;
  write_content(files.newest, damaged);
  std::string warned;
  RunSceneOptions options = stopping_after(1000);
  options.warning = [&warned](const std::string& warning) { warned += warning; };
  resume_run(folder / "run", {}, options);
  CHECK(contains(warned, "checkpoint.h5: damaged: "));
  CHECK(contains(warned, "going on from checkpoint.previous.h5"));
  CHECK(read_checkpoint(files.newest).state.step_number == 3000);
  CHECK(read_checkpoint(files.previous).state.step_number == 2000);
  resume_run(folder / "run", {}, threads(1));
  check_same(outcomes_of(folder / "run"), outcomes_of(folder / "whole"));
}

TEST_CASE("a checkpoint that a kill left on its way to its place is taken there") {
  const TemporaryFolder folder;
  run_scene(scene_of(small_scene()), folder / "run", threads(1));
  const CheckpointFiles files(folder / "run");
  std::filesystem::rename(files.newest, files.next);
  CHECK(resume_run(folder / "run", {}, threads(1)).status == RunStatus::done_before);
  CHECK(std::filesystem::exists(files.newest));
  CHECK_FALSE(std::filesystem::exists(files.next));
}
