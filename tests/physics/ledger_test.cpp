// The energy balance of Table 5, and its amplitude when the long form is asked for.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <utility>

using namespace grandamp;
using namespace grandamp::test;

namespace {

template <class Run> void check_ledger(const Scene& scene, double tolerance) {
  Run run(scene);
  const Sample start = run.sample();
  double worst = 0.0;
  const std::int64_t steps = steps_of(scene);
  for (std::int64_t n = 0; n < steps; ++n) {
    run.step();
    if (n > steps / 10 && n % (steps / 20) == 0)
      worst = std::max(worst, std::abs(ledger_residual(start, run.sample())));
  }
  const Sample end = run.sample();
  MESSAGE("work in ", end.ledger.work_in, " J, structure ", end.ledger.structural_damping, ", normal ",
          end.ledger.normal_granule, " and ", end.ledger.normal_wall, ", friction ", end.ledger.friction_granule,
          " and ", end.ledger.friction_wall, "; residual ", 100.0 * ledger_residual(start, end), " %");
  CHECK(std::abs(ledger_residual(start, end)) < tolerance);
  CHECK(worst < 2.0 * tolerance);
  CHECK(end.ledger.normal_granule > 0.0);
  CHECK(end.ledger.normal_wall > 0.0);
  CHECK(end.ledger.friction_granule > 0.0);
  CHECK(end.ledger.friction_wall > 0.0);
}

/// What the losses booked for a head-on contact fall short of what its kinetic energy lost, over that, in the mean over
/// phases of entry.
template <class Run> double left_over(double restitution, Integrator integrator, double steps_per_contact) {
  constexpr int phases = 40;
  const double speed = 2.0;
  double lost = 0.0, booked = 0.0;
  for (int p = 0; p < phases; ++p) {
    Scene scene = two_granules(1.5e-3, 0.5 * speed, 0.0);
    const double step = pair_contact_duration(scene, speed) / steps_per_contact;
    scene = two_granules(1.5e-3, 0.5 * speed, speed * step * (1.0 + (p + 0.5) / phases));
    scene.contact.granule.alpha.reset();
    scene.contact.granule.restitution = restitution;
    scene.time.integrator = integrator;
    scene.time.duration *= 2.0; // heavy damping draws the contact out
    use_step(scene, step);
    Run run(scene);
    const Sample start = run.sample();
    run_all(run, scene);
    const Sample end = run.sample();
    REQUIRE(end.contacts == 0);
    lost += start.stored.kinetic - end.stored.kinetic;
    booked += end.ledger.normal_granule;
  }
  return 1.0 - booked / lost;
}

} // namespace

TEST_CASE_TEMPLATE("the ledger of a contact is right to fourth order in the step, however strong the damping", Run,
                   OracleRun, SolverRun) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const double restitution : {0.9, 0.5, 0.1}) {
      const double at_8 = left_over<Run>(restitution, integrator, 8.0);
      const double at_16 = left_over<Run>(restitution, integrator, 16.0);
      MESSAGE("e = ", restitution, ": ", at_8, " left over at 8 steps, ", at_16, " at 16");
      CHECK(std::abs(at_8) < 0.005);
      CHECK(std::abs(at_16) < 0.0005);
    }
}

TEST_CASE("Table 5 for 0.2 s: the ledger closes within one percent") {
  Scene scene = table_5(317, 0.2);
  use_step(scene, shortest_contact_duration(scene, 2.0) / 8.0);
  check_ledger<SolverRun>(scene, 0.01);
  if (full_tests()) check_ledger<OracleRun>(scene, 0.01);
}

TEST_CASE_TEMPLATE("a gas that comes to rest in a shaken box: the ledger closes within one percent", Run, OracleRun,
                   SolverRun) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Scene scene = gas(100, 0.022, 1.0, 41);
    scene.gravity = {0.0, 0.0, -9.81};
    scene.excitation.kind = ExcitationKind::prescribed;
    scene.excitation.amplitude = 1.0e-3;
    scene.excitation.frequency = 60.0;
    scene.time.integrator = integrator;
    scene.time.duration = 0.02;
    use_step(scene, shortest_contact_duration(scene, 2.0) / 8.0);
    check_ledger<Run>(scene, 0.01);
  }
}

namespace {

/// Seven seconds, the statistics of the last half, the ledger at the end.
std::pair<ResponseStatistics, Ledger> seven_seconds(Scene scene) {
  scene.output.window = {3.5, 7.0};
  use_step(scene, shortest_contact_duration(scene, 2.0) / 8.0);
  SolverRun run(scene);
  const Sample start = run.sample();
  run_all(run, scene);
  const Sample end = run.sample();
  const ResponseStatistics response = run.simulation().response();
  MESSAGE("amplitude ", response.amplitude, " m, rms ", response.rms_displacement, " m, work in ", end.ledger.work_in,
          " J, residual ", ledger_residual(start, end));
  CHECK(std::abs(ledger_residual(start, end)) < 0.01);
  return {response, end.ledger};
}

} // namespace

TEST_CASE("Table 5 for 7 s: the amplitude within four percent of 4.68 mm, the ledger within one" *
          doctest::skip(!full_tests())) {
  const auto [response, ledger] = seven_seconds(table_5(317, 7.0));
  CHECK(response.amplitude == doctest::Approx(4.68e-3).epsilon(0.04));
  // A force of 0.5 N can give no more than F_rms V_rms T.
  const double velocity = 2.0 * std::numbers::pi * 15.91 * response.rms_displacement;
  CHECK(ledger.work_in < 1.02 * 0.5 / std::sqrt(2.0) * velocity * 7.0);
}

TEST_CASE("490 granules of 1.6 mm at 15.5 Hz for 7 s: rms within four percent of 3.29 mm, 0.69 J put in" *
          doctest::skip(!full_tests())) {
  const auto [response, ledger] = seven_seconds(vertical_damper(490, 1.6e-3, 15.5, 7.0));
  CHECK(response.rms_displacement == doctest::Approx(3.29e-3).epsilon(0.04));
  CHECK(ledger.work_in == doctest::Approx(0.69).epsilon(0.05));
}
