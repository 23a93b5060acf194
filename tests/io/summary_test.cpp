// summary.json: its keys, and the balance that it draws up.
#include "io/plan_report.hpp"
#include "io/progress.hpp"
#include "io/summary.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <limits>

using namespace grandamp;

namespace {

Plan some_plan() {
  Plan plan;
  plan.scene.title = "a \xFF title";
  plan.scene.structure = Structure{};
  plan.scene.time.duration = 0.3;
  plan.granules = 10;
  plan.steps = 3000;
  plan.time_step = 1e-4;
  plan.window = {0.15, 0.3};
  plan.effects = {"hertz"};
  return plan;
}

RunRecord some_record(const Plan& plan) {
  RunRecord record;
  record.plan = &plan;
  record.isa = "generic";
  record.steps = 3000;
  record.time = 1e-4 * 3000; // not 0.3 to the last bit
  record.wall_time = 0.5;
  record.end.time = record.time;
  record.initial.stored = {1.0, 20.0, 2.0, 3.0};
  record.end.stored = {2.0, 19.0, 1.0, 5.0};
  record.end.ledger = {10.0, 1.0, 2.0, 3.0, 1.0, 1.5};
  return record;
}

nlohmann::json parsed(const RunRecord& record) {
  return nlohmann::json::parse(summary_text(record));
}

} // namespace

TEST_CASE("the summary has every key of the contract") {
  const Plan plan = some_plan();
  const auto summary = parsed(some_record(plan));
  for (const char* key : {"title", "granules", "duration", "time_step", "steps", "contact_duration", "wall_time",
                          "granule_steps_per_second", "threads", "isa", "precision", "effects", "effects_left_out",
                          "structure", "energy", "verlet", "guards"}) {
    CHECK_MESSAGE(summary.contains(key), key);
  }
  for (const char* key : {"rms_displacement", "peak_displacement", "amplitude", "steady", "window"}) {
    CHECK_MESSAGE(summary["structure"].contains(key), key);
  }
  for (const char* key :
       {"initial", "kinetic", "gravitational", "elastic", "structure", "work_in", "structural_damping",
        "normal_granule", "normal_wall", "friction_granule", "friction_wall", "residual"}) {
    CHECK_MESSAGE(summary["energy"].contains(key), key);
  }
  for (const char* key : {"builds", "mean_interval", "candidates_per_granule", "contacts_per_granule", "audited",
                          "missed", "missed_pair_steps"}) {
    CHECK_MESSAGE(summary["verlet"].contains(key), key);
  }
  for (const char* key : {"max_overlap", "max_speed", "escaped"}) CHECK_MESSAGE(summary["guards"].contains(key), key);
  CHECK(summary["duration"] == 0.3);
  CHECK(summary["granule_steps_per_second"] == 60000.0);
  CHECK(summary["status"] == "done");
  CHECK_FALSE(summary.contains("message"));
}

TEST_CASE("free vibration tells its cycles, forced vibration has none") {
  Plan plan = some_plan();
  RunRecord record = some_record(plan);
  record.response.cycles = {{0.1, 0.01, 0.5, 0.2, 0.03}, {0.2, 0.008, 0.4, 0.1, 0.01}};
  const auto cycles = parsed(record)["structure"]["cycles"];
  REQUIRE(cycles.size() == 2);
  CHECK(cycles[0] == nlohmann::json{{"start", 0.1},
                                    {"amplitude", 0.01},
                                    {"peak_kinetic_energy", 0.5},
                                    {"specific_damping_capacity", 0.2},
                                    {"damping_ratio", 0.03}});
  plan.scene.excitation.kind = ExcitationKind::harmonic;
  CHECK_FALSE(parsed(record)["structure"].contains("cycles"));
}

TEST_CASE("what a run does not have is left out") {
  Plan plan = some_plan();
  plan.scene.structure.reset();
  plan.scene.output.energy = false;
  const auto summary = parsed(some_record(plan));
  CHECK_FALSE(summary.contains("structure"));
  CHECK_FALSE(summary.contains("energy"));
}

TEST_CASE("a run that was stopped says how far it came") {
  const Plan plan = some_plan();
  RunRecord record = some_record(plan);
  record.status = RunStatus::stopped_by_guard;
  record.message = "granule 3 has escaped";
  record.steps = 1000;
  record.time = 0.1;
  record.end.time = 0.09;
  const auto summary = parsed(record);
  CHECK(summary["status"] == "stopped by a guard");
  CHECK(summary["message"] == "granule 3 has escaped");
  CHECK(summary["steps"] == 1000);
  CHECK(summary["duration"] == 0.1);
  CHECK(summary["planned_steps"] == 3000);
  CHECK(summary["planned_duration"] == 0.3);
  CHECK(summary["energy"]["time"] == 0.09);
}

TEST_CASE("the residual is what is left over the largest of the work and what there was") {
  const Plan plan = some_plan();
  RunRecord record = some_record(plan);
  // 26 + 10 in, 27 stored, 8.5 lost: half a joule is left of ten.
  CHECK(energy_residual(record.initial, record.end) == doctest::Approx(0.05).epsilon(1e-14));
  record.end.ledger.work_in = 1.0; // now the 6 J of the start are the largest
  CHECK(energy_residual(record.initial, record.end) == doctest::Approx(8.5 / 6.0).epsilon(1e-14));
  CHECK(energy_residual({}, {}) == 0.0);
  Sample fallen; // from rest, one joule of height turned into motion
  fallen.stored = {0.99, -1.0, 0.0, 0.0};
  CHECK(energy_residual({}, fallen) == doctest::Approx(0.01).epsilon(1e-12));
}

TEST_CASE("progress and plan lines") {
  CHECK(readable_seconds(3.04) == "3.0 s");
  CHECK(readable_seconds(250.0) == "4 min 10 s");
  CHECK(readable_seconds(7500.0) == "2 h 05 min");
  RunProgress progress;
  progress.time = 1.0;
  progress.duration = 4.0;
  progress.wall_time = 20.0;
  progress.rate = 42e6;
  CHECK(progress_line(progress) == "1 of 4 s (25.0 %), 42.0 M granule-steps/s, 20 s, 1 min 00 s left");
  progress.amplitude = 4.68e-3;
  CHECK(progress_line(progress).ends_with(", amplitude 4.680 mm"));

  Plan plan = some_plan();
  plan.damper.mass_ratio = 0.1;
  plan.damper.clearance = std::numeric_limits<double>::quiet_NaN();
  const std::string text = plan_text(plan, "generic", 1);
  CHECK(text.find("mass ratio") != std::string::npos);
  CHECK(text.find("nan") == std::string::npos);
  const auto json = nlohmann::json::parse(plan_json(plan, "generic", 1));
  CHECK(json["damper"]["mass_ratio"] == 0.1);
  CHECK(json["damper"]["clearance"].is_null());
  CHECK(json["steps"] == 3000);
}
