// grandamp optimise, as a user types it.
#include "tests/io/sweep_support.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>

using namespace grandamp::test;

namespace {

namespace fs = std::filesystem;

void put_scene(const TemporaryFolder& folder) {
  write_content(folder / "small.toml", small_scene());
}

std::size_t runs_told(const nlohmann::json& search) {
  std::size_t runs = 0;
  for (const auto& evaluation : search["evaluations"]) runs += evaluation["runs"].size();
  return runs;
}

} // namespace

TEST_CASE("optimise: a bare structure is tuned to where the closed form has its peak") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = "optimise small.toml --maximise structure.amplitude --over structure.stiffness=120:320 "
                              "--set granules.0.count=0 --set structure.damping=0.5 --set time.duration=1.0 --seeds 1 "
                              "--set time.step=1e-4 --evaluations 16 -o best";
  const Outcome outcome = program(folder, command);
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  const nlohmann::json search = json_of(folder / "best/optimise.json");
  const double peak = 0.02 * std::pow(2.0 * std::numbers::pi * 16.0, 2); // K = M w^2
  const nlohmann::json best = search["evaluations"][search["best"].get<std::size_t>()];
  CHECK(best["values"]["structure.stiffness"].get<double>() == doctest::Approx(peak).epsilon(0.03));
  CHECK(contains(outcome.output, "Greatest structure.amplitude"));
  CHECK(search["scene_as_it_is"] == 0);
  CHECK(rows_of(folder / "best/optimise.csv").size() == search["evaluations"].size());
  CHECK(content_of(folder / "best/optimise.svg").starts_with("<svg"));
  CHECK(content_of(folder / "best/design_1.svg").starts_with("<svg"));
  // The best scene is one to go on with.
  REQUIRE(program(folder, "run best/best.toml -o again").status == 0);
  CHECK(json_of(folder / "again/summary.json")["structure"]["amplitude"] == best["mean"]);

  // Again: replayed from the folder.
  const auto before = runs_in(folder / "best");
  const Outcome again = program(folder, command + " --json --quiet");
  REQUIRE(again.status == 0);
  CHECK(nlohmann::json::parse(again.output) == search);
  CHECK(runs_in(folder / "best") == before);
}

TEST_CASE("optimise: a radius at one total mass, as good as the grid's best within the errors, in fewer runs") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string settings = " --keep total_mass --set time.duration=0.12 --set granules.0.density=7800.0 ";
  REQUIRE(program(folder, "sweep small.toml --vary granules.0.radius=1.0e-3:2.4e-3:9 --seeds 4 -o grid" + settings)
              .status == 0);
  const nlohmann::json grid = json_of(folder / "grid/sweep.json");
  double least = 1.0, error = 0.0;
  for (const auto& point : grid["points"])
    if (const double rms = point["mean"]["structure.rms_displacement"]; rms < least) {
      least = rms;
      error = point["error"]["structure.rms_displacement"];
    }
  const Outcome outcome = program(folder, "optimise small.toml --minimise structure.rms_displacement --over "
                                          "granules.0.radius=1.0e-3:2.4e-3 --seeds 2 --evaluations 8 -o best" +
                                              settings);
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const nlohmann::json search = json_of(folder / "best/optimise.json");
  const nlohmann::json best = search["evaluations"][search["best"].get<std::size_t>()]["all_seeds"];
  const double own_error = best["standard_error"];
  CHECK(own_error > 0.0);
  CHECK(best["mean"].get<double>() <= least + 2.0 * std::hypot(error, own_error));
  CHECK(runs_told(search) < 36);
  for (const auto& evaluation : search["evaluations"])
    CHECK(evaluation["granule_mass"].get<double>() ==
          doctest::Approx(search["evaluations"][0]["granule_mass"].get<double>()).epsilon(1e-14));
  // Common random numbers: the same seeds everywhere.
  for (const auto& evaluation : search["evaluations"]) {
    CHECK(evaluation["runs"][0]["seed"] == 3);
    CHECK(evaluation["runs"][1]["seed"] == 4);
  }
}

TEST_CASE("optimise: interrupted it goes on, and comes to the same") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = "optimise small.toml --minimise energy.kinetic --over granules.0.count=2:20 --seeds 2 "
                              "--evaluations 6 --threads 2 --set time.duration=0.1 -o ";
  REQUIRE(program(folder, command + "whole").status == 0);
  const Outcome stopped =
      shell(folder, std::string(GRANDAMP_PROGRAM) + " " + command +
                        "best & run=$!\nfor i in $(seq 2000); do ls best/runs/*/summary.json >/dev/null 2>&1 && break; "
                        "sleep 0.005; done\nkill -INT $run; wait $run");
  INFO(stopped.errors);
  REQUIRE(stopped.status == 130);
  const auto done = runs_in(folder / "best");
  CHECK(done.size() >= 1);
  CHECK(json_of(folder / "best/optimise.json")["status"] == "incomplete");
  REQUIRE(program(folder, command + "best").status == 0);
  const auto all = runs_in(folder / "best");
  for (const auto& [name, time] : done) CHECK(all.at(name) == time);
  CHECK(json_of(folder / "best/optimise.json") == json_of(folder / "whole/optimise.json"));
  // Counts are whole, and none is tried twice.
  std::set<double> counts;
  const nlohmann::json search = json_of(folder / "best/optimise.json");
  for (const auto& evaluation : search["evaluations"]) {
    const double count = evaluation["values"]["granules.0.count"];
    CHECK(count == std::round(count));
    CHECK(counts.insert(count).second);
  }
}

TEST_CASE("optimise: designs that cannot be run are told and passed by") {
  const TemporaryFolder folder;
  put_scene(folder);
  const Outcome outcome = program(folder, "optimise small.toml --minimise structure.rms_displacement --over "
                                          "granules.0.radius=1e-3:9e-3 --seeds 1 --evaluations 6 --set "
                                          "time.duration=0.1 -o best");
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  const nlohmann::json search = json_of(folder / "best/optimise.json");
  std::size_t failed = 0;
  for (const auto& evaluation : search["evaluations"]) failed += evaluation["status"] == "failed" ? 1 : 0;
  CHECK(failed >= 2);
  CHECK(search["evaluations"][search["best"].get<std::size_t>()]["status"] == "done");
}

TEST_CASE("optimise: what is asked for wrongly is status 2, before anything runs") {
  const TemporaryFolder folder;
  put_scene(folder);
  const auto refused = [&](const std::string& options, const std::string& message) {
    const Outcome outcome = program(folder, "optimise small.toml -o bad " + options);
    CAPTURE(options);
    INFO(outcome.errors);
    CHECK(outcome.status == 2);
    CHECK(contains(outcome.errors, message));
    CHECK_FALSE(fs::exists(folder / "bad/runs"));
  };
  const std::string over = " --over granules.0.radius=1e-3:2e-3";
  refused("--minimise structure.rms" + over, "there are: granules, duration, ");
  refused("--minimise structure.rms" + over, "structure.rms_displacement");
  refused("--minimise structure.rms_displacement" + over + " --set output.energy=false --maximise energy.kinetic",
          "excludes");
  refused("--minimise energy.kinetic --set output.energy=false" + over, "no number of this scene's summary");
  refused("--minimise structure.amplitude", "--over");
  refused(over, "one of --minimise and --maximise");
  refused("--minimise structure.amplitude --over granules.0.radius=2e-3:1e-3", "is not below");
  refused("--minimise structure.amplitude --over granules.0.radiuss=1e-3:2e-3", "perhaps radius");
  refused("--minimise structure.amplitude --keep total_mass --over structure.mass=1:2", "changes the granules' mass");
  refused("--minimise structure.amplitude --evaluations 1" + over, "--evaluations");
}
