// The program as a user meets it: exit statuses, what goes to which stream, what is refused.
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace grandamp::test;

namespace {

void put_scene(const TemporaryFolder& folder) {
  write_content(folder / "small.toml", small_scene());
}

} // namespace

TEST_CASE("run, then export: status 0, nothing on standard output but what was asked for") {
  const TemporaryFolder folder;
  put_scene(folder);
  const Outcome run = program(folder, "run small.toml --threads 1");
  INFO(run.errors);
  REQUIRE(run.status == 0);
  CHECK(run.output.empty());
  CHECK(contains(run.errors, "results in small"));
  CHECK(std::filesystem::exists(folder / "small/summary.json"));

  const Outcome history = program(folder, "export small history -o history.csv");
  REQUIRE(history.status == 0);
  const auto rows = lines_of(content_of(folder / "history.csv"));
  CHECK(rows.size() == 52);
  CHECK(rows[0] == "time,displacement,velocity,excitation,reaction,kinetic,elastic,gravitational,contacts,work_in,"
                   "structural_damping,normal_granule,normal_wall,friction_granule,friction_wall,structure");
  CHECK(program(folder, "export small granules -o granules.csv").status == 0);
  CHECK(lines_of(content_of(folder / "granules.csv")).size() == 9);
  CHECK(program(folder, "export small granules --time 0.05 -o granules.csv").status == 0);

  const Outcome early = program(folder, "export small granules --time 0.01 -o early.csv");
  CHECK(early.status == 2);
  CHECK(contains(early.errors, "took no snapshots"));
  CHECK_FALSE(std::filesystem::exists(folder / "early.csv"));
  CHECK(program(folder, "export small history --time 0.05 -o early.csv").status == 2);
  CHECK(program(folder, "export small granules -o /dev/full").status == 4);
  CHECK(program(folder, "export nowhere granules -o granules.csv").status == 4);
}

TEST_CASE("--json prints the summary and nothing else, --quiet says nothing") {
  const TemporaryFolder folder;
  put_scene(folder);
  const Outcome run = program(folder, "run small.toml -o run --json --quiet --threads 1");
  REQUIRE(run.status == 0);
  CHECK(run.errors.empty());
  CHECK(run.output == content_of(folder / "run/summary.json"));
  CHECK(nlohmann::json::parse(run.output)["granules"] == 8);
}

TEST_CASE("--set overrides, and the folder tells what was run") {
  const TemporaryFolder folder;
  put_scene(folder);
  const Outcome run = program(folder, "run small.toml --set granules.0.count=3 --set time.duration=0.01 --json");
  REQUIRE(run.status == 0);
  const auto summary = nlohmann::json::parse(run.output);
  CHECK(summary["granules"] == 3);
  CHECK(summary["duration"] == 0.01);
  // What the folder holds gives the same run again.
  const Outcome again = program(folder, "run small/scene.toml -o again --json");
  REQUIRE(again.status == 0);
  const auto repeated = nlohmann::json::parse(again.output);
  CHECK(repeated["structure"] == summary["structure"]);
  CHECK(repeated["energy"] == summary["energy"]);
}

TEST_CASE("a folder that holds a run: status 2, and --force") {
  const TemporaryFolder folder;
  put_scene(folder);
  const std::string command = "run small.toml --set time.duration=1e-3";
  REQUIRE(program(folder, command).status == 0);
  const Outcome refused = program(folder, command);
  CHECK(refused.status == 2);
  CHECK(contains(refused.errors, "--force"));
  CHECK(program(folder, command + " --force").status == 0);
}

TEST_CASE("bad usage and bad scenes: status 2 and where it is wrong") {
  const TemporaryFolder folder;
  put_scene(folder);
  for (const char* arguments :
       {"", "run", "dance small.toml", "run small.toml --colour red", "run small.toml --threads 0",
        "run small.toml --threads many", "run small.toml --isa z80", "run small.toml --max-wall 0", "resume",
        "resume small --force", "sweep small.toml --vary a=1:2:3", "sweep small.toml", "optimise small.toml", "report",
        "inspect", "export small pictures -o x.csv", "export small history"}) {
    const Outcome outcome = program(folder, arguments);
    CHECK_MESSAGE(outcome.status == 2, arguments);
    CHECK_MESSAGE(contains(outcome.errors, "error: "), arguments);
    CHECK_MESSAGE(outcome.output.empty(), arguments);
  }
  CHECK(program(folder, "report small").status == 4);
  CHECK(program(folder, "resume small").status == 4);

  std::string text = small_scene();
  text.replace(text.find("radius = 1.5e-3"), 15, "radius = -1    ");
  text.replace(text.find("kind = \"random\""), 15, "kind = \"heaped\"");
  write_content(folder / "bad.toml", text);
  for (const char* command : {"run", "check"}) {
    const Outcome outcome = program(folder, std::string(command) + " bad.toml --json");
    CHECK(outcome.status == 2);
    CHECK(outcome.output.empty());
    CHECK(contains(outcome.errors, "bad.toml:12:"));
    CHECK(contains(outcome.errors, "bad.toml:16:"));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "bad"));
}

TEST_CASE("files that cannot be read or written: status 4, path and reason") {
  const TemporaryFolder folder;
  put_scene(folder);
  const Outcome absent = program(folder, "run absent.toml");
  CHECK(absent.status == 4);
  CHECK(contains(absent.errors, "absent.toml"));
  write_content(folder / "taken", "a file");
  const Outcome taken = program(folder, "run small.toml -o taken");
  CHECK(taken.status == 4);
  CHECK(contains(taken.errors, "taken: is a file"));
  CHECK(program(folder, "run small.toml -o taken/deeper").status == 4);
  const Outcome nowhere = program(folder, "run small.toml -o /proc/grandamp");
  CHECK(nowhere.status == 4);
  CHECK(contains(nowhere.errors, "/proc/grandamp"));
  // 512-byte blocks: the scene fits, the results do not.
  const Outcome full = shell(folder, "ulimit -f 4; " + std::string(GRANDAMP_PROGRAM) + " run small.toml -o full");
  CHECK(full.status == 4);
  CHECK(contains(full.errors, "results.h5"));
}

TEST_CASE("a numerical guard: status 3, and what was recorded is kept") {
  const TemporaryFolder folder;
  put_scene(folder);
  const Outcome outcome =
      program(folder, // A closing speed far below what the granules have: the step is then too long for them.
              "run small.toml -o run --set granules.0.speed=30 --set time.impact_speed=1e-3 --set time.step=5e-5 "
              "--set output.history_interval=5e-5 --threads 1 --json");
  INFO(outcome.errors);
  REQUIRE(outcome.status == 3);
  const auto summary = nlohmann::json::parse(outcome.output);
  CHECK(summary["status"] == "stopped by a guard");
  CHECK(contains(outcome.errors, summary["message"].get<std::string>()));
  CHECK(summary["steps"] < summary["planned_steps"]);
  CHECK(summary["structure"]["amplitude"].is_null()); // the window was never reached
  const Outcome history = program(folder, "export run history -o history.csv");
  CHECK(history.status == 0);
  CHECK(lines_of(content_of(folder / "history.csv")).size() >= 2);
  const Outcome granules = program(folder, "export run granules -o granules.csv");
  CHECK(granules.status == 4);
  CHECK(contains(granules.errors, "stopped"));
}

TEST_CASE("an interrupt: status 130, and what there is so far is written") {
  const TemporaryFolder folder;
  put_scene(folder);
  for (const std::string signal : {"INT", "TERM"}) {
    const Outcome outcome = shell(folder, std::string(GRANDAMP_PROGRAM) + " run small.toml -o " + signal +
                                              " --set time.duration=1e4 --set output.history_interval=1e-2 & run=$!\n"
                                              "for i in $(seq 100); do [ -e " +
                                              signal +
                                              "/scene.toml ] && break; sleep 0.1; done; sleep 0.3\n"
                                              "kill -" +
                                              signal + " $run; wait $run");
    INFO(outcome.errors);
    CHECK(outcome.status == 130);
    CHECK(contains(outcome.errors, "interrupted"));
    const auto summary = nlohmann::json::parse(content_of(folder / signal / "summary.json"));
    CHECK(summary["status"] == "interrupted");
    CHECK(summary["steps"] > 0);
    CHECK(summary["steps"] < summary["planned_steps"]);
    CHECK(program(folder, "export " + signal + " granules -o " + signal + ".csv").status == 0);
  }
}

TEST_CASE("check tells what would run, in words and as JSON, and leaves nothing") {
  const TemporaryFolder folder;
  put_scene(folder);
  const Outcome words = program(folder, "check small.toml");
  INFO(words.errors);
  REQUIRE(words.status == 0);
  for (const char* label : {"granules", "effects", "left out", "time step", "steps", "memory", "wall time",
                            "mass ratio", "fill fraction", "clearance", "acceleration", "natural frequency"}) {
    CHECK_MESSAGE(contains(words.output, label), label);
  }
  const Outcome json = program(folder, "check small.toml --json --set time.duration=0.1");
  REQUIRE(json.status == 0);
  const auto plan = nlohmann::json::parse(json.output);
  CHECK(plan["granules"] == 8);
  CHECK(plan["steps"] == 20000);
  CHECK(plan["damper"]["natural_frequency"].get<double>() == doctest::Approx(15.9155).epsilon(1e-4));
  CHECK_FALSE(std::filesystem::exists(folder / "small"));
}

TEST_CASE("check finds granules that overlap at the start") {
  const TemporaryFolder folder;
  std::string text = small_scene();
  text.replace(text.find("count = 8"), 9, "positions = [[0.005, 0.005, 0.005], [0.005, 0.005, 0.0051]]");
  const std::string packing = "[packing]\nkind = \"random\"\n";
  text.erase(text.find(packing), packing.size());
  write_content(folder / "overlap.toml", text);
  const Outcome outcome = program(folder, "check overlap.toml");
  CHECK(outcome.status == 2);
  CHECK(contains(outcome.errors, "overlap.toml:"));
}

TEST_CASE("--version and --help") {
  const TemporaryFolder folder;
  const Outcome version = program(folder, "--version");
  CHECK(version.status == 0);
  CHECK(contains(version.output, "grandamp "));
  CHECK(contains(version.output, "generic"));
  CHECK(contains(version.output, "HDF5 1."));
  const Outcome help = program(folder, "--help");
  CHECK(help.status == 0);
  CHECK(contains(help.output, "export"));
}
