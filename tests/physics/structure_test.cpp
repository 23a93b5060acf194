// The structure without granules, against closed forms: free, forced, resonant, overdamped, without stiffness, without
// damping, at steps fine and coarse.
#include "tests/support/closed_form.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <complex>
#include <numbers>

using namespace grandamp;
using namespace grandamp::test;

namespace {

template <class Run, class Displacement, class Velocity>
void compare(const Scene& scene, const Displacement& displacement, const Velocity& velocity) {
  Run run(scene);
  double error = 0.0, scale = 0.0, velocity_error = 0.0, velocity_scale = 0.0;
  const std::int64_t steps = steps_of(scene), stride = std::max<std::int64_t>(1, steps / 1000);
  for (std::int64_t n = 0; n <= steps; ++n) {
    if (n % stride == 0) {
      const Sample now = run.sample();
      const double t = static_cast<double>(n) * run.time_step();
      CHECK(now.time == doctest::Approx(t).epsilon(1.0e-12));
      error = std::max(error, std::abs(now.displacement - displacement(t)));
      velocity_error = std::max(velocity_error, std::abs(now.velocity - velocity(t)));
      scale = std::max(scale, std::abs(displacement(t)));
      velocity_scale = std::max(velocity_scale, std::abs(velocity(t)));
    }
    if (n < steps) run.step();
  }
  CHECK(scale > 0.0);
  CHECK(error < 1.0e-6 * scale);
  CHECK(velocity_error < 1.0e-6 * velocity_scale);
}

template <class Run> void compare_with_closed_form(const Scene& scene) {
  const double force = scene.excitation.kind == ExcitationKind::none
                           ? 0.0
                           : scene.excitation.force.value_or(scene.structure->stiffness *
                                                             scene.excitation.static_deflection.value_or(0.0));
  const ClosedForm exact(*scene.structure, force, scene.excitation.frequency);
  compare<Run>(
      scene, [&](double t) { return exact.displacement(t); }, [&](double t) { return exact.velocity(t); });
}

Scene free_structure() {
  Scene scene = bare_structure();
  scene.excitation = Excitation{};
  scene.structure->displacement = 1.0e-3;
  scene.structure->velocity = -0.07;
  scene.time.duration = 1.0;
  use_step(scene, 1.0e-4);
  return scene;
}

} // namespace

TEST_CASE_TEMPLATE("free vibration without granules is the closed form", Run, OracleRun, SolverRun) {
  Scene scene = free_structure();
  compare_with_closed_form<Run>(scene);
  scene.structure->damping = 0.0;
  compare_with_closed_form<Run>(scene);
  scene.structure->damping = 50.0; // overdamped: critical is 20
  compare_with_closed_form<Run>(scene);
  scene.structure->damping = 0.2;
  scene.time.duration = 0.1;
  scene.structure->stiffness = 1000.0 * 1.0e6; // 16 kHz: a step of 1e-4 s is 1.6 periods
  compare_with_closed_form<Run>(scene);
}

TEST_CASE_TEMPLATE("forced vibration from rest, transient included, is the closed form", Run, OracleRun, SolverRun) {
  Scene scene = bare_structure();
  scene.time.duration = 2.0;
  use_step(scene, 1.0e-4);
  compare_with_closed_form<Run>(scene);
  scene.structure->displacement = 3.0e-3;
  scene.structure->velocity = 0.4;
  scene.structure->direction = {0.6, 0.0, 0.8};
  scene.excitation.static_deflection.reset();
  scene.excitation.force = 0.7;
  scene.excitation.frequency = 37.0;
  compare_with_closed_form<Run>(scene);
  use_step(scene, 9.0e-3); // three steps to a forcing period
  compare_with_closed_form<Run>(scene);
}

TEST_CASE_TEMPLATE("critical damping, undamped resonance and no stiffness are the closed forms", Run, OracleRun,
                   SolverRun) {
  const double mass = 0.1, omega = 100.0;
  Scene critical = free_structure();
  critical.structure->damping = 2.0 * mass * omega;
  const double x0 = 1.0e-3, v0 = -0.07, slope = v0 + omega * x0;
  compare<Run>(
      critical, [&](double t) { return (x0 + slope * t) * std::exp(-omega * t); },
      [&](double t) { return (slope - omega * (x0 + slope * t)) * std::exp(-omega * t); });

  Scene resonant = bare_structure();
  resonant.structure->damping = 0.0;
  resonant.excitation.frequency = omega / (2.0 * std::numbers::pi);
  resonant.time.duration = 2.0;
  use_step(resonant, 1.0e-4);
  const double grow = 0.5e-3 / 2.0; // static deflection over two
  compare<Run>(
      resonant, [&](double t) { return grow * (std::sin(omega * t) - omega * t * std::cos(omega * t)); },
      [&](double t) { return grow * omega * omega * t * std::sin(omega * t); });

  Scene sliding = free_structure();
  sliding.structure->stiffness = 0.0;
  const double rate = 0.2 / mass;
  compare<Run>(
      sliding, [&](double t) { return x0 + v0 / rate * (1.0 - std::exp(-rate * t)); },
      [&](double t) { return v0 * std::exp(-rate * t); });

  sliding.structure->damping = 0.0;
  sliding.excitation.kind = ExcitationKind::harmonic;
  sliding.excitation.force = 0.3;
  sliding.excitation.frequency = 10.0;
  const double w = 20.0 * std::numbers::pi, push = 0.3 / (mass * w);
  compare<Run>(
      sliding, [&](double t) { return x0 + (v0 + push) * t - push / w * std::sin(w * t); },
      [&](double t) { return v0 + push * (1.0 - std::cos(w * t)); });
}

TEST_CASE_TEMPLATE("the bare structure's ledger closes: work in is stored or damped", Run, OracleRun, SolverRun) {
  Scene scene = bare_structure();
  scene.structure->velocity = 0.1;
  scene.time.duration = 1.0;
  use_step(scene, 1.0e-4);
  Run run(scene);
  const Sample start = run.sample();
  run_all(run, scene);
  const Sample end = run.sample();
  CHECK(end.ledger.work_in > 0.0);
  CHECK(end.ledger.structural_damping > 0.0);
  CHECK(start.stored.structure == doctest::Approx(0.5 * 0.1 * 0.01));
  CHECK(std::abs(ledger_residual(start, end)) < 1.0e-9);
}

TEST_CASE("the bare structure of Table 5 has the closed form's amplitude and rms") {
  Scene scene = bare_structure();
  scene.time.duration = 7.0;
  scene.output.window = {3.5, 7.0};
  use_step(scene, 1.0e-4);
  SolverRun run(scene);
  run_all(run, scene);
  const ClosedForm exact(*scene.structure, 0.5, 15.91);
  const double period = 1.0 / 15.91;
  double square = 0.0, peak = 0.0, amplitude = 0.0;
  int samples = 0, periods = 0;
  for (double t = 3.5; t < 7.0; t += 1.0e-4, ++samples) {
    square += exact.displacement(t) * exact.displacement(t);
    peak = std::max(peak, std::abs(exact.displacement(t)));
  }
  for (double from = 3.5; from + period <= 7.0; from += period, ++periods) {
    double low = 0.0, high = 0.0;
    for (double t = from; t < from + period; t += 1.0e-4) {
      low = std::min(low, exact.displacement(t));
      high = std::max(high, exact.displacement(t));
    }
    amplitude += 0.5 * (high - low);
  }
  const ResponseStatistics told = run.simulation().response();
  CHECK(told.rms_displacement == doctest::Approx(std::sqrt(square / samples)).epsilon(1.0e-4));
  CHECK(told.peak_displacement == doctest::Approx(peak).epsilon(1.0e-4));
  CHECK(told.amplitude == doctest::Approx(amplitude / periods).epsilon(1.0e-4));
  CHECK(told.amplitude == doctest::Approx(24.79e-3).epsilon(1.0e-3));
  CHECK(told.cycle_amplitudes.size() == static_cast<std::size_t>(periods));
}
