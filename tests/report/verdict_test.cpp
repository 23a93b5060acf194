// When a page says not to believe it.
#include "io/report_verdict.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace grandamp;
using namespace grandamp::report;
using grandamp::test::contains;

namespace {

using Json = nlohmann::ordered_json;

/// A run of 2 s at 10 Hz against which nothing speaks: amplitude 1 mm, from 1 s on.
RunFacts good_run() {
  RunFacts run;
  run.summary = Json::parse(R"({"status": "done", "duration": 2.0, "planned_duration": 2.0, "impact_speed": 1.0,
    "structure": {"amplitude": 1e-3, "rms_displacement": 7e-4, "steady": true, "window": [1.0, 2.0]},
    "energy": {"residual": 1e-3}, "verlet": {"missed": 0, "missed_pair_steps": 0, "audited": 10},
    "guards": {"max_overlap": 0.01, "max_closing_speed": 0.9, "escaped": 0}})");
  run.scene.emplace();
  run.scene->structure.emplace();
  run.scene->time.duration = 2.0;
  run.scene->excitation.kind = ExcitationKind::harmonic;
  run.scene->excitation.frequency = 10.0;
  run.history.names = {"time", "displacement"};
  run.history.columns.resize(2);
  for (int k = 0; k <= 2000; ++k) {
    run.history.columns[0].push_back(1e-3 * k);
    run.history.columns[1].push_back(1e-3 * std::sin(2.0 * std::numbers::pi * 10.0 * 1e-3 * k));
  }
  return run;
}

struct Told {
  Doubt gravest;
  std::string text;
};
Told told(const RunFacts& run) {
  const std::vector<Caution> cautions = cautions_of(run);
  Told all{cautions.front().doubt, ""};
  for (const Caution& one : cautions)
    if (one.doubt != Doubt::none) all.text += one.what + " " + one.so + "\n";
  return all;
}

} // namespace

TEST_CASE("a run against which nothing speaks") {
  const Told good = told(good_run());
  CHECK(good.gravest == Doubt::none);
  CHECK(good.text.empty());
}

TEST_CASE("what casts doubt on a run is told, and how grave it is") {
  struct Case {
    const char* path;
    Json value;
    Doubt gravest;
    const char* words;
  };
  const Case cases[] = {
      {"/structure/steady", false, Doubt::some, "Not steady"},
      {"/structure/amplitude", nullptr, Doubt::serious, "no amplitude"},
      {"/energy/residual", 0.02, Doubt::some, "balance is off by 2 %"},
      {"/energy/residual", 0.2, Doubt::serious, "balance is off by 20 %"},
      {"/energy/residual", nullptr, Doubt::serious, "balance is off"},
      {"/verlet/missed", 3, Doubt::some, "3 contacts began without being listed"},
      {"/guards/escaped", 2, Doubt::serious, "2 granules left"},
      {"/guards/max_overlap", 0.2, Doubt::some, "deepest overlap was 20 %"},
      {"/guards/max_closing_speed", 3.0, Doubt::some, "closed at 3 m/s"},
      {"/status", "interrupted", Doubt::serious, "was interrupted"},
      {"/status", "stopped by a guard", Doubt::serious, "stopped by a guard"},
      {"/structure/window", Json::array({1.8, 2.0}), Doubt::some, "only 2 periods"},
  };
  for (const Case& one : cases) {
    RunFacts run = good_run();
    run.summary[Json::json_pointer(one.path)] = one.value;
    const Told doubts = told(run);
    INFO(one.path, ": ", doubts.text);
    CHECK(doubts.gravest == one.gravest);
    CHECK(contains(doubts.text, one.words));
  }
}

TEST_CASE("a run without a summary is not finished, whatever else there is") {
  RunFacts run = good_run();
  run.summary = nullptr;
  const Told doubts = told(run);
  CHECK(doubts.gravest == Doubt::serious);
  CHECK(contains(doubts.text, "not finished"));
  CHECK(contains(doubts.text, "until 2 s of 2 s"));
}

TEST_CASE("a list policy that can miss contacts and was not audited is told of") {
  RunFacts run = good_run();
  run.summary["verlet"]["audited"] = 0;
  CHECK(told(run).gravest == Doubt::none);
  run.scene->verlet.policy = ListPolicy::predicted;
  CHECK(contains(told(run).text, "can miss contacts"));
}

TEST_CASE("histories too coarse for their period are told of") {
  RunFacts run = good_run();
  for (std::vector<double>& column : run.history.columns) {
    std::vector<double> few;
    for (std::size_t k = 0; k < column.size(); k += 20) few.push_back(column[k]);
    column = few;
  }
  CHECK(contains(told(run).text, "5 rows in a period"));
}

TEST_CASE("amplitudes cycle by cycle") {
  RunFacts run = good_run();
  const std::vector<Cycle> forced = cycles_of(run);
  REQUIRE(forced.size() == 20);
  for (const Cycle& cycle : forced) CHECK(cycle.amplitude == doctest::Approx(1e-3).epsilon(1e-3));
  CHECK(forced.front().start == doctest::Approx(0.0));
  run.scene->excitation.kind = ExcitationKind::none; // from crossing to crossing
  const std::vector<Cycle> free = cycles_of(run);
  CHECK(free.size() >= 18);
  for (const Cycle& cycle : free) CHECK(cycle.amplitude == doctest::Approx(1e-3).epsilon(1e-3));
}
