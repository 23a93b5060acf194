// All that `grandamp run` does, through the library.
#include "io/results.hpp"
#include "io/run.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace grandamp;
using namespace grandamp::test;

namespace {

RunSceneOptions one_thread() {
  RunSceneOptions options;
  options.threads = 1;
  return options;
}

std::vector<double> column(const History& history, const std::string& name) {
  for (std::size_t i = 0; i < history.names.size(); ++i) {
    if (history.names[i] == name) return history.columns[i];
  }
  throw std::runtime_error("no column " + name);
}

} // namespace

TEST_CASE("a run leaves its scene, its summary and its results, and they agree") {
  const TemporaryFolder folder;
  const SceneDocument document = read_scene_text(small_scene(), "small.toml");
  const RunResult result = run_scene(document, folder / "run", one_thread());
  CHECK(result.status == RunStatus::done);
  CHECK(result.steps == 10000);
  CHECK(content_of(folder / "run/scene.toml") == document.text);
  CHECK(content_of(folder / "run/summary.json") == result.summary);

  const auto summary = nlohmann::json::parse(result.summary);
  CHECK(summary["title"] == "Eight granules");
  CHECK(summary["granules"] == 8);
  CHECK(summary["duration"] == 0.05);
  CHECK(summary["steps"] == 10000);
  CHECK(summary["threads"] == 1);
  CHECK(summary["granule_steps_per_second"] > 0.0);

  const History history = read_history(folder / "run/results.h5");
  const auto time = column(history, "time");
  REQUIRE(time.size() == 51);
  for (std::size_t row = 0; row < time.size(); ++row) {
    CHECK(time[row] == doctest::Approx(1e-3 * static_cast<double>(row)).epsilon(1e-9));
  }
  // The summary's energies are those of the first and the last row, and every row closes the balance.
  const auto& energy = summary["energy"];
  for (const char* name : {"kinetic", "gravitational", "elastic", "structure"}) {
    CHECK(energy["initial"][name] == column(history, name).front());
    CHECK(energy[name] == column(history, name).back());
  }
  for (const char* name :
       {"work_in", "structural_damping", "normal_granule", "normal_wall", "friction_granule", "friction_wall"}) {
    CHECK(energy[name] == column(history, name).back());
    CHECK(column(history, name).front() == 0.0);
  }
  CHECK(energy["residual"] < 0.05);
  CHECK(energy["work_in"] > 0.0);
  CHECK(summary["structure"]["rms_displacement"] == result.response->rms_displacement);
  CHECK(read_stored_scene(folder / "run/results.h5") == document.text);
}

TEST_CASE("history rows are at the steps nearest to the multiples, each step once") {
  const TemporaryFolder folder;
  const auto times = [&](const std::string& interval) {
    const SceneDocument document =
        read_scene_text(small_scene(), "small.toml",
                        {"time.duration=1e-3", "output.history_interval=" + interval, "output.window=[0, 1e-3]"});
    RunSceneOptions options = one_thread();
    options.force = true;
    run_scene(document, folder / "run", options);
    return column(read_history(folder / "run/results.h5"), "time");
  };
  const auto finer = times("1e-6"); // than a step: every step
  REQUIRE(finer.size() == 201);
  for (std::size_t n = 0; n < finer.size(); ++n) CHECK(finer[n] == doctest::Approx(5e-6 * static_cast<double>(n)));
  const auto odd = times("1.2e-5"); // 2.4 steps: 0, 2, 5, 7, 10, 12, 14, ...
  REQUIRE(odd.size() > 6);
  const std::vector<double> steps{0, 2, 5, 7, 10, 12, 14};
  for (std::size_t row = 0; row < steps.size(); ++row) CHECK(odd[row] == doctest::Approx(5e-6 * steps[row]));
  CHECK(times("0.9e-3").size() == 2); // the second multiple is beyond the end
}

TEST_CASE("what is recorded does not change what happens") {
  const TemporaryFolder folder;
  const auto granules = [&](const std::string& interval) {
    const SceneDocument document =
        read_scene_text(small_scene(), "small.toml", {"output.history_interval=" + interval});
    run_scene(document, folder / ("every " + interval), one_thread());
    return read_final_granules(folder / ("every " + interval) / "results.h5").table;
  };
  const GranuleTable often = granules("1e-5");
  const GranuleTable seldom = granules("1e-2");
  CHECK(often.position == seldom.position);
  CHECK(often.velocity == seldom.velocity);
  CHECK(often.spin == seldom.spin);
}

TEST_CASE("exported granules start another scene as they were") {
  const TemporaryFolder folder;
  run_scene(read_scene_text(small_scene(), "small.toml"), folder / "run", one_thread());
  const Snapshot end = read_final_granules(folder / "run/results.h5");
  CHECK(end.time == doctest::Approx(0.05).epsilon(1e-12));
  export_granules(end.table, folder / "bed.csv");

  std::string text = small_scene();
  const std::string counted = "count = 8\nradius = 1.5e-3\n";
  text.replace(text.find(counted), counted.size(), "file = \"bed.csv\"\n");
  const std::string packing = "[packing]\nkind = \"random\"\n";
  text.erase(text.find(packing), packing.size());
  write_content(folder / "again.toml", text);
  const Population again = read_scene(folder / "again.toml").scene.populations.at(0);
  CHECK(again.positions == end.table.position);
  CHECK(again.velocities == end.table.velocity);
  CHECK(again.spins == end.table.spin);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK((again.radii.empty() ? again.radius : again.radii[i]) == end.table.radius[i]);
  }
}

TEST_CASE("a folder that holds a run is left alone without force, and only the run is replaced with it") {
  const TemporaryFolder folder;
  const SceneDocument document = read_scene_text(small_scene(), "small.toml", {"time.duration=1e-3"});
  run_scene(document, folder / "run", one_thread());
  write_content(folder / "run/notes.txt", "mine");
  write_content(folder / "run/summary.json", "old");
  CHECK_THROWS_WITH_AS(run_scene(document, folder / "run", one_thread()), doctest::Contains("--force"), UsageError);
  CHECK(content_of(folder / "run/summary.json") == "old");
  RunSceneOptions forced = one_thread();
  forced.force = true;
  run_scene(document, folder / "run", forced);
  CHECK(content_of(folder / "run/summary.json") != "old");
  CHECK(content_of(folder / "run/notes.txt") == "mine");
}

TEST_CASE("a bad scene costs the folder nothing and leaves none behind") {
  const TemporaryFolder folder;
  SceneDocument document = read_scene_text(small_scene(), "small.toml");
  document.scene.populations[0].placed = true;
  document.scene.populations[0].positions.assign(8, {0.005, 0.005, 0.005}); // all in one place
  CHECK_THROWS_AS(run_scene(document, folder / "run", one_thread()), SceneError);
  CHECK_FALSE(std::filesystem::exists(folder / "run"));
}

TEST_CASE("a run asked to stop writes what it has and says how far it came") {
  const TemporaryFolder folder;
  RunSceneOptions options = one_thread();
  int asked = 0;
  options.stop_requested = [&asked] { return ++asked > 1000; };
  const RunResult result = run_scene(read_scene_text(small_scene(), "small.toml"), folder / "run", options);
  CHECK(result.status == RunStatus::interrupted);
  CHECK(result.steps == 1000);
  const auto summary = nlohmann::json::parse(content_of(folder / "run/summary.json"));
  CHECK(summary["status"] == "interrupted");
  CHECK(summary["steps"] == 1000);
  CHECK(summary["planned_steps"] == 10000);
  CHECK(read_history(folder / "run/results.h5").columns.front().size() == 6);
  CHECK(read_final_granules(folder / "run/results.h5").time == doctest::Approx(5e-3));
}

TEST_CASE("progress is told to the end") {
  const TemporaryFolder folder;
  RunSceneOptions options = one_thread();
  RunProgress last;
  int told = 0;
  options.progress = [&](const RunProgress& progress) {
    if (!progress.pouring) CHECK(progress.time >= last.time);
    last = progress;
    ++told;
  };
  run_scene(read_scene_text(small_scene(), "small.toml"), folder / "run", options);
  CHECK(told >= 1);
  CHECK(last.time == doctest::Approx(0.05));
  CHECK(last.duration == doctest::Approx(0.05));
  CHECK(last.rate > 0.0);
}
