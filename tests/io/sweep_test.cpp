// grandamp sweep, as a user types it.
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

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double standard_error(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += std::pow(value - mean(values), 2);
  const auto count = static_cast<double>(values.size());
  return std::sqrt(squares / (count - 1.0)) / std::sqrt(count);
}

} // namespace

TEST_CASE("sweep: every number is that of a single run, and the seeds' means and errors are plain statistics") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = "sweep small.toml --vary structure.damping=0.05,0.1 --vary contact.friction=coulomb,none "
                              "--seeds 3 -o sweep";
  const Outcome first = program(folder, command);
  INFO(first.errors);
  REQUIRE(first.status == 0);
  CHECK(contains(first.errors, "4 points, 3 seeds: 12 runs"));
  CHECK(first.output.empty());
  const nlohmann::json sweep = json_of(folder / "sweep/sweep.json");
  CHECK(sweep["status"] == "done");
  CHECK(sweep["points"].size() == 4);
  CHECK(sweep["seeds"] == nlohmann::json{3, 4, 5});
  const auto points = rows_of(folder / "sweep/sweep.csv");
  const auto runs = rows_of(folder / "sweep/sweep_runs.csv");
  REQUIRE(points.size() == 4);
  REQUIRE(runs.size() == 12);

  REQUIRE(program(folder, "run small.toml -o one --set structure.damping=0.1 --set contact.friction=none --set seed=4")
              .status == 0);
  const nlohmann::json one = json_of(folder / "one/summary.json");
  const nlohmann::json there = json_of(folder / "sweep" / sweep["points"][3]["runs"][1]["folder"] / "summary.json");
  CHECK(there["structure"] == one["structure"]);
  CHECK(there["energy"] == one["energy"]);
  const nlohmann::json numbers = sweep["points"][3]["runs"][1]["numbers"];
  CHECK(numbers["energy.normal_wall"] == one["energy"]["normal_wall"]);
  CHECK(std::stod(runs[10].at("structure.rms_displacement")) == one["structure"]["rms_displacement"].get<double>());
  CHECK(runs[10].at("seed") == "4");
  CHECK(runs[10].at("contact.friction") == "none");
  CHECK(runs[10].at("status") == "done");

  for (std::size_t k = 0; k < 4; ++k)
    for (const char* number : {"structure.rms_displacement", "structure.peak_displacement", "energy.friction_wall",
                               "energy.dissipated", "structure.steady"}) {
      CAPTURE(k);
      CAPTURE(number);
      std::vector<double> values;
      for (std::size_t seed = 0; seed < 3; ++seed) values.push_back(std::stod(runs[3 * k + seed].at(number)));
      CHECK(std::stod(points[k].at(number)) == doctest::Approx(mean(values)).epsilon(1e-13));
      CHECK(std::stod(points[k].at(std::string(number) + "_error")) ==
            doctest::Approx(standard_error(values)).epsilon(1e-9));
      CHECK(sweep["points"][k]["mean"][number].get<double>() == std::stod(points[k].at(number)));
    }
  for (const char* picture : {"sweep.svg", "dissipation.svg"})
    CHECK(content_of(folder / "sweep" / picture).starts_with("<svg"));
  const Outcome inspected = program(folder, "inspect sweep/sweep.h5");
  CHECK(inspected.status == 0);
  CHECK(contains(inspected.output, "/runs/structure.rms_displacement"));

  const auto before = runs_in(folder / "sweep");
  CHECK(before.size() == 12);
  const Outcome again = program(folder, command + " --json --quiet");
  CHECK(again.status == 0);
  CHECK(again.errors.empty());
  CHECK(nlohmann::json::parse(again.output) == json_of(folder / "sweep/sweep.json"));
  CHECK(runs_in(folder / "sweep") == before);
  // More seeds are more runs, not others.
  CHECK(program(folder, "sweep small.toml --vary structure.damping=0.05,0.1 --vary contact.friction=coulomb,none "
                        "--seeds 4 -o sweep")
            .status == 0);
  auto more = runs_in(folder / "sweep");
  CHECK(more.size() == 16);
  for (const auto& [name, time] : before) CHECK(more.at(name) == time);
}

TEST_CASE("sweep: a folder of something else is refused, and told what differs") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = "sweep small.toml --set time.duration=0.01 -o sweep --vary structure.mass=";
  REQUIRE(program(folder, command + "0.02,0.03").status == 0);
  const Outcome other = program(folder, command + "0.02,0.04");
  CHECK(other.status == 2);
  CHECK(contains(other.errors, "varied: structure.mass = 0.02, 0.03 there, structure.mass = 0.02, 0.04 here"));
  const Outcome scene = program(folder, command + "0.02,0.03 --set structure.damping=0.06");
  CHECK(scene.status == 2);
  CHECK(contains(scene.errors, "scene: line "));
  CHECK(program(folder, command + "0.02,0.04 --force").status == 0);
  CHECK(rows_of(folder / "sweep/sweep.csv")[1].at("structure.mass") == "0.04");
  REQUIRE(program(folder, "run small.toml -o run --set time.duration=0.01").status == 0);
  const Outcome run = program(folder, "sweep small.toml -o run --vary structure.mass=0.02,0.03");
  CHECK(run.status == 2);
  CHECK(contains(run.errors, "holds something that is no sweep"));
  CHECK(program(folder, "sweep small.toml -o run --force --vary structure.mass=0.02,0.03").status == 2);
  CHECK(program(folder, "run small.toml -o sweep").status == 2);
}

TEST_CASE("sweep: bad input is status 2 before anything runs") {
  const TemporaryFolder folder;
  put_scene(folder);
  const auto refused = [&](const std::string& options, const std::string& message) {
    const Outcome outcome = program(folder, "sweep small.toml -o bad " + options);
    CAPTURE(options);
    INFO(outcome.errors);
    CHECK(outcome.status == 2);
    CHECK(contains(outcome.errors, message));
    CHECK_FALSE(fs::exists(folder / "bad"));
  };
  refused("", "--vary");
  refused("--vary structure.masss=1,2", "perhaps mass");
  refused("--vary structure.mass=-1,-2", "structure.mass = -1");
  refused("--vary structure.mass=1,2 --seeds 0", "--seeds");
  refused("--vary structure.mass=1,2 --index 2 --of 2", "no such part");
  refused("--vary structure.mass=1,2 --index 0", "--index and --of go together");
  refused("--vary structure.mass=1,2 --index 0 --of 2 --force", "--force and --of");
  refused("--vary structure.mass=1,2 --keep mass", "--keep");
  refused("--vary structure.mass=1,2 --keep total_mass", "changes the granules' mass");
  refused("--vary structure.mass=1,2 --isa avx9", "--isa");
}

TEST_CASE("sweep: a case that fails is told and stops no other") {
  const TemporaryFolder folder;
  put_scene(folder);
  // The second is no scene (granules wider than the box), the third is flung beyond what the time step can follow.
  const std::string command = "sweep small.toml --vary granules.0.radius=1.5e-3,6e-3 --vary excitation.force=0.5,1e6 "
                              "--set time.impact_speed=1.0 -o sweep";
  const Outcome outcome = program(folder, command);
  INFO(outcome.errors);
  CHECK(outcome.status == 3);
  CHECK(contains(outcome.errors, "3 of 4 runs failed"));
  const nlohmann::json sweep = json_of(folder / "sweep/sweep.json");
  CHECK(sweep["status"] == "partly failed");
  CHECK(sweep["runs"]["failed"] == 3);
  CHECK(sweep["points"][0]["status"] == "done");
  CHECK(sweep["points"][1]["status"] == "failed");
  CHECK(sweep["points"][1]["runs"][0]["exit_status"] == 3);
  CHECK_FALSE(sweep["points"][1]["runs"][0]["error"].get<std::string>().empty());
  CHECK(sweep["points"][2]["runs"][0]["exit_status"] == 2);
  CHECK(contains(sweep["points"][2]["runs"][0]["error"], "does not fit"));
  CHECK(contains(rows_of(folder / "sweep/sweep.csv")[2].at("error"), "does not fit"));
  // A guard would stop the same run again.
  const auto stopped = fs::last_write_time(folder / "sweep/runs/001_seed3/summary.json");
  CHECK(program(folder, command).status == 3);
  CHECK(fs::last_write_time(folder / "sweep/runs/001_seed3/summary.json") == stopped);
}

TEST_CASE("sweep: interrupted and started again it repeats nothing, and the numbers are those of one go") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = "sweep small.toml --vary time.duration=0.1,0.2,0.3,0.25,3.0 --threads 2";
  REQUIRE(program(folder, command + " -o whole").status == 0);
  const Outcome stopped =
      shell(folder, std::string(GRANDAMP_PROGRAM) + " " + command +
                        " -o sweep & run=$!\nfor i in $(seq 2000); do ls sweep/runs/*/summary.json >/dev/null 2>&1 && "
                        "break; sleep 0.005; done\nkill -TERM $run; wait $run");
  INFO(stopped.errors);
  REQUIRE(stopped.status == 130);
  CHECK(contains(stopped.errors, "interrupted"));
  const auto done = runs_in(folder / "sweep");
  CHECK(done.size() >= 1);
  CHECK(done.size() < 4);
  CHECK(json_of(folder / "sweep/sweep.json")["status"] == "incomplete");
  // The longest begins first; half-way, it has a checkpoint, and goes on from it.
  std::set<std::string> half_way;
  for (const auto& entry : fs::directory_iterator(folder / "sweep/runs"))
    if (fs::exists(entry.path() / "checkpoint.h5") && !done.contains(entry.path().filename().string()))
      half_way.insert(entry.path().filename().string());
  CHECK(half_way.contains("004_seed3"));
  const Outcome again = program(folder, command + " -o sweep");
  INFO(again.errors);
  REQUIRE(again.status == 0);
  CHECK(contains(again.errors, std::to_string(done.size()) + " done before"));
  const auto all = runs_in(folder / "sweep");
  CHECK(all.size() == 5);
  for (const auto& [name, time] : done) CHECK(all.at(name) == time);
  for (const auto& [name, time] : all) {
    CAPTURE(name);
    const nlohmann::json here = json_of(folder / "sweep/runs" / name / "summary.json");
    const nlohmann::json there = json_of(folder / "whole/runs" / name / "summary.json");
    CHECK(here["structure"] == there["structure"]);
    CHECK(here["energy"] == there["energy"]);
  }
  // What went on was not begun anew: a run anew would have removed this.
  for (const std::string& name : half_way) CHECK(fs::exists(folder / "sweep/runs" / name / "checkpoint.previous.h5"));
}

TEST_CASE("sweep: wall time ends it with checkpoints, a killed run is tried again") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = "sweep small.toml --vary structure.damping=0.05,0.1 --set time.duration=3.0 -o sweep";
  const Outcome over = program(folder, command + " --max-wall 0.1");
  INFO(over.errors);
  CHECK(over.status == 130);
  const Outcome killed = shell(
      folder, std::string(GRANDAMP_PROGRAM) + " " + command +
                  " --threads 1 & run=$!\nfor i in $(seq 500); do child=$(cat /proc/$run/task/$run/children); [ -n "
                  "\"$child\" ] && break; sleep 0.01; done\nsleep 0.1; kill -KILL $child; wait $run");
  INFO(killed.errors);
  CHECK(killed.status == 3);
  CHECK(contains(killed.errors, "ended by signal 9"));
  CHECK(json_of(folder / "sweep/sweep.json")["runs"]["failed"] == 1);
  CHECK(program(folder, command).status == 0);
  CHECK(json_of(folder / "sweep/sweep.json")["status"] == "done");
}

TEST_CASE("sweep: parts of a job array side by side make one table") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = " sweep small.toml --vary structure.damping=0.05:0.1:3 --seeds 3 -o sweep";
  std::string script;
  for (int part = 0; part < 3; ++part)
    script += GRANDAMP_PROGRAM + command + " --threads 1 --index " + std::to_string(part) + " --of 3 & p" +
              std::to_string(part) + "=$!\n";
  const Outcome outcome = shell(folder, script + "s=0; wait $p0 || s=1; wait $p1 || s=1; wait $p2 || s=1; exit $s");
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  const auto all = runs_in(folder / "sweep");
  CHECK(all.size() == 9);
  CHECK(json_of(folder / "sweep/sweep.json")["status"] == "done");
  CHECK(rows_of(folder / "sweep/sweep.csv").size() == 3);
  // One part alone does its share and no more.
  REQUIRE(
      shell(folder, GRANDAMP_PROGRAM + std::string(" sweep small.toml --vary structure.damping=0.05:0.1:3 --seeds 3 "
                                                   "-o other --index 1 --of 3"))
          .status == 0);
  CHECK(runs_in(folder / "other").size() == 3);
  CHECK(json_of(folder / "other/sweep.json")["status"] == "incomplete");
}

TEST_CASE("sweep: the response stands beside the closed forms") {
  const TemporaryFolder folder;
  put_scene(folder);
  REQUIRE(program(folder, "sweep small.toml --vary excitation.frequency=14,16 -o sweep").status == 0);
  const auto rows = rows_of(folder / "sweep/response.csv");
  const double granules = json_of(folder / "sweep/sweep.json")["points"][0]["granule_mass"];
  for (const auto& row : rows) {
    const double w = 2.0 * std::numbers::pi * std::stod(row.at("excitation.frequency"));
    const auto amplitude = [w](double mass) {
      return 0.5 / std::sqrt(std::pow(200.0 - mass * w * w, 2) + std::pow(0.05 * w, 2));
    };
    CHECK(std::stod(row.at("bare_amplitude")) == doctest::Approx(amplitude(0.02)).epsilon(1e-12));
    CHECK(std::stod(row.at("added_mass_amplitude")) == doctest::Approx(amplitude(0.02 + granules)).epsilon(1e-12));
  }
  CHECK(contains(content_of(folder / "sweep/response.svg"), "granules as added mass"));
}

TEST_CASE("sweep: damping against acceleration, from the histories' energies") {
  const TemporaryFolder folder;
  put_scene(folder);
  REQUIRE(program(folder, "sweep small.toml --vary excitation.force=0.02,0.05 --set time.duration=0.5 "
                          "--set output.window=[0.25,0.5] -o sweep")
              .status == 0);
  const auto rows = rows_of(folder / "sweep/damping.csv");
  REQUIRE(rows.size() == 2);
  REQUIRE(program(folder, "export sweep/runs/001_seed3 history -o history.csv").status == 0);
  const auto history = rows_of(folder / "history.csv");
  const auto lost = [&](std::size_t row) {
    double sum = 0.0;
    for (const char* one : {"normal_granule", "normal_wall", "friction_granule", "friction_wall"})
      sum += std::stod(history[row].at(one));
    return sum;
  };
  // Rows are a millisecond apart, four periods of 16 Hz are 0.25 s.
  REQUIRE(history.size() == 501);
  const double each = (lost(500) - lost(250)) / 4.0;
  REQUIRE(each > 0.0);
  const double amplitude = json_of(folder / "sweep/runs/001_seed3/summary.json")["structure"]["amplitude"];
  const double w = 2.0 * std::numbers::pi * 16.0;
  CHECK(std::stod(rows[1].at("acceleration")) == doctest::Approx(w * w * amplitude / 9.81).epsilon(1e-12));
  CHECK(std::stod(rows[1].at("dissipated")) == doctest::Approx(each).epsilon(1e-9));
  CHECK(std::stod(rows[1].at("loss_factor")) ==
        doctest::Approx(each / (2.0 * std::numbers::pi * 0.5 * 0.02 * std::pow(w * amplitude, 2))).epsilon(1e-9));
  // The damper c that takes as much in a cycle, pi c w a^2, over the critical 2 sqrt(K M).
  const double c = each / (std::numbers::pi * w * amplitude * amplitude);
  CHECK(std::stod(rows[1].at("ratio")) == doctest::Approx(c / (2.0 * std::sqrt(200.0 * 0.02))).epsilon(1e-9));
  CHECK(contains(content_of(folder / "sweep/damping.svg"), "dimensionless acceleration"));
}

TEST_CASE("sweep: sizes at one total mass") {
  const TemporaryFolder folder;
  put_scene(folder);
  REQUIRE(program(folder, "sweep small.toml --vary granules.0.radius=1.2e-3:2.2e-3:4 --keep total_mass "
                          "--set time.duration=0.01 -o sweep")
              .status == 0);
  const nlohmann::json sweep = json_of(folder / "sweep/sweep.json");
  CHECK(sweep["keep"] == "total_mass");
  std::set<int> counts;
  const double total = 8.0 * 1190.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(1.5e-3, 3);
  for (const auto& point : sweep["points"]) {
    CHECK(point["granule_mass"].get<double>() == doctest::Approx(total).epsilon(1e-14));
    counts.insert(point["granules"].get<int>());
  }
  CHECK(counts == std::set<int>{3, 4, 7, 16});
}
