// grandamp study accuracy, as a user types it.
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace grandamp::test;

namespace {

namespace fs = std::filesystem;

std::map<std::string, fs::file_time_type> cases_in(const fs::path& folder) {
  std::map<std::string, fs::file_time_type> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "cases"))
    files[entry.path().filename().string()] = entry.last_write_time();
  return files;
}

const std::string short_study =
    "study accuracy small.toml --seeds 2 --vary steps,integrator --set time.duration=0.05 -o study";

} // namespace

TEST_CASE("study accuracy: tables, pictures, a recommendation, and a second start that runs nothing again") {
  const TemporaryFolder folder;
  write_content(folder / "small.toml", small_scene());
  const Outcome first = program(folder, short_study + " --error 2%");
  INFO(first.errors);
  REQUIRE(first.status == 0);
  CHECK(contains(first.output, "For an error of 2 %: "));
  CHECK(contains(first.errors, "16 settings, 2 seeds: 32 runs of 8 granules"));
  const auto study = nlohmann::json::parse(content_of(folder / "study" / "study.json"));
  CHECK(study["runs"]["done"] == 32);
  CHECK(study["settings"].size() == 16);
  CHECK(study["recommended"]["by_observables"].is_string());
  for (const auto& setting : study["settings"]) {
    CAPTURE(setting["name"].get<std::string>());
    CHECK(setting["runs"] == 2);
    CHECK(setting["time"] > 0.0);
    CHECK(setting["contact_error"] > 0.0);
    for (const char* observable : {"rms_displacement", "dissipated", "normal_wall", "contacts_per_granule"})
      CHECK(setting["observables"].contains(observable));
  }
  // What a setting says of itself can be run by hand.
  CHECK(study["settings"][0]["overrides"][2] == "time.precision=double");
  CHECK(lines_of(content_of(folder / "study" / "study.csv")).size() == 17);
  CHECK(contains(content_of(folder / "study" / "study.md"), "| T_c/64 (reference) |"));
  for (const char* picture : {"error_time.svg", "response_time.svg", "rate_step.svg", "missed_policy.svg"})
    CHECK(content_of(folder / "study" / picture).starts_with("<svg"));

  const auto before = cases_in(folder / "study");
  CHECK(before.size() == 32);
  const Outcome again = program(folder, short_study + " --error 0.02 --json");
  REQUIRE(again.status == 0);
  CHECK(cases_in(folder / "study") == before);
  const auto repeated = nlohmann::json::parse(again.output);
  CHECK(repeated["settings"] == study["settings"]);

  // A damaged case is run again, the others are not.
  write_content(folder / "study" / "cases" / "steps-8_seed1.json", "{\"setting\": 3}");
  REQUIRE(program(folder, short_study).status == 0);
  std::size_t changed = 0;
  for (const auto& [name, time] : cases_in(folder / "study")) changed += time == before.at(name) ? 0 : 1;
  CHECK(changed == 1);
}

TEST_CASE("study accuracy: interrupted by a signal or by wall time, it keeps what is done and goes on") {
  const TemporaryFolder folder;
  write_content(folder / "small.toml", small_scene());
  const std::string command =
      "study accuracy small.toml --seeds 1 --vary steps --set time.duration=0.2 --threads 1 -o study";
  const Outcome stopped =
      shell(folder,
            std::string(GRANDAMP_PROGRAM) + " " + command +
                " & run=$!\nfor i in $(seq 300); do [ -e study/cases/steps-6_seed0.json ] && break; sleep 0.05; done\n"
                "kill -INT $run; wait $run");
  INFO(stopped.errors);
  CHECK(stopped.status == 130);
  CHECK(contains(stopped.errors, "interrupted"));
  const auto so_far = nlohmann::json::parse(content_of(folder / "study" / "study.json"));
  CHECK(so_far["runs"]["done"] >= 2);
  CHECK(so_far["runs"]["done"] < so_far["runs"]["planned"]);
  const auto before = cases_in(folder / "study");
  CHECK(program(folder, command + " --max-wall 1e-9").status == 130);
  CHECK(cases_in(folder / "study") == before);
  REQUIRE(program(folder, command).status == 0);
  const auto after = cases_in(folder / "study");
  CHECK(after.size() == so_far["runs"]["planned"]);
  for (const auto& [name, time] : before) CHECK(after.at(name) == time);
  const auto whole = nlohmann::json::parse(content_of(folder / "study" / "study.json"));
  CHECK(whole["settings"][0]["observables"]["amplitude"]["mean"] > 0.0);
}

TEST_CASE("study accuracy: policies are audited, and what the scene does not bear is left out with a reason") {
  const TemporaryFolder folder;
  std::string text = small_scene();
  text += "[contact]\nfriction = \"none\"\n";
  text.erase(text.find("friction = 0.52\n"), 16);
  write_content(folder / "small.toml", text);
  const Outcome outcome = program(
      folder,
      "study accuracy small.toml --seeds 1 --vary policy,skin,friction,stiffness --set time.duration=0.002 -o s");
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  CHECK(contains(outcome.errors, "left out: friction: the scene has none"));
  const auto study = nlohmann::json::parse(content_of(folder / "s" / "study.json"));
  std::map<std::string, nlohmann::json> settings;
  for (const auto& setting : study["settings"]) settings[setting["name"]] = setting;
  for (const char* name : {"policy-predicted", "policy-fixed", "own"}) {
    CAPTURE(name);
    REQUIRE(settings.contains(name));
    CHECK(settings[name]["audit"]["steps_compared"] > 10);
  }
  CHECK(settings["own"]["audit"]["missed"] == 0);
  CHECK(settings.contains("policy-all-pairs"));
  CHECK(settings.contains("skin-0.1"));
  CHECK(settings["stiffness-0.01"]["time_step"].get<double>() > 0.0);
  CHECK(settings["stiffness-0.01"]["overrides"][0] == "contact.granule.stiffness=100000");
}

TEST_CASE("study accuracy: a scene without a structure is judged by its granules' energy") {
  const TemporaryFolder folder;
  std::string text = small_scene();
  text.erase(text.find("[structure]"), text.find("[time]") - text.find("[structure]"));
  write_content(folder / "small.toml", text);
  const Outcome outcome =
      program(folder, "study accuracy small.toml --seeds 1 --vary steps --set time.duration=0.02 -o s");
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  const auto study = nlohmann::json::parse(content_of(folder / "s" / "study.json"));
  CHECK(study["settings"][0]["observables"].contains("kinetic"));
  CHECK_FALSE(study["settings"][0]["observables"].contains("amplitude"));
}

TEST_CASE("study accuracy: bad usage and folders") {
  const TemporaryFolder folder;
  write_content(folder / "small.toml", small_scene());
  const std::string study = "study accuracy small.toml --seeds 1 --vary steps --set time.duration=1e-3";
  for (const char* error : {"0", "-1%", "51%", "0.6", "nan", "abc", "1%%", "1 percent", "''"}) {
    const Outcome outcome = program(folder, study + " --error " + error);
    CHECK_MESSAGE(outcome.status == 2, error);
    CHECK_MESSAGE(contains(outcome.errors, "error: "), error);
  }
  for (const char* arguments : {"study", "study small.toml", "study accuracy", "study speed small.toml",
                                "study accuracy small.toml --seeds 0", "study accuracy small.toml --vary colour"})
    CHECK_MESSAGE(program(folder, arguments).status == 2, arguments);
  const Outcome bare = program(folder, study + " --set granules.0.count=0");
  CHECK(bare.status == 2);
  CHECK(contains(bare.errors, "no granules"));
  CHECK(program(folder, "study accuracy absent.toml").status == 4);

  CHECK(program(folder, study + " -o /proc/grandamp").status == 4);
  write_content(folder / "taken", "a file");
  CHECK(program(folder, study + " -o taken").status == 4);
  REQUIRE(program(folder, "run small.toml --set time.duration=1e-3 -o run").status == 0);
  const Outcome refused = program(folder, study + " -o run");
  CHECK(refused.status == 2);
  CHECK(contains(refused.errors, "no study"));
  CHECK(fs::exists(folder / "run" / "summary.json"));

  REQUIRE(program(folder, study + " -o s").status == 0);
  const Outcome other = program(folder, study + " --set time.duration=2e-3 -o s");
  CHECK(other.status == 2);
  CHECK(contains(other.errors, "--force"));
  CHECK(program(folder, study + " --set time.duration=2e-3 -o s --force").status == 0);
}
