// Forces that repeat themselves: periodic random ones and sweep after sweep.
#include "solver/excitation_signal.hpp"
#include "solver/periodic_random_force.hpp"
#include "solver/plan.hpp"

#include <cmath>
#include <complex>
#include <doctest/doctest.h>
#include <numbers>
#include <string>

using namespace grandamp;

namespace {

constexpr double pi = std::numbers::pi;

Scene driven(ExcitationKind kind) {
  Scene scene;
  scene.enclosure.size = {0.1, 0.1, 0.1};
  scene.structure = Structure{.mass = 1.0, .stiffness = 1e4, .damping = 1.0};
  scene.excitation.kind = kind;
  scene.time.duration = 10.0;
  scene.time.step = 1e-3;
  return scene;
}

std::string faults_of(const Scene& scene) {
  try {
    make_plan(scene);
  } catch (const SceneError& error) {
    std::string all;
    for (const Problem& problem : error.problems())
      all += problem.key + " = " + problem.value + ": " + problem.message + "; " + problem.allowed + "\n";
    return all;
  }
  return {};
}

} // namespace

TEST_CASE("a periodic random force has the lines of its band alone, of one amplitude, and its rms") {
  constexpr double rms = 3.0, period = 4.0;
  const PeriodicRandomForce force(rms, {10.0, 22.0}, period, 1, 0);
  constexpr int samples = 4096;
  const std::int64_t lines = PeriodicRandomForce::lines_in({10.0, 22.0}, period);
  CHECK(lines == 49);
  for (int k = 0; k < 200; ++k) {
    std::complex<double> sum = 0.0;
    for (int n = 0; n < samples; ++n)
      sum += force.at({period * n / samples, 0.0}) * std::polar(1.0, -2.0 * pi * k * n / samples);
    const double amplitude = 2.0 * std::abs(sum) / samples;
    const bool inside = k >= 40 && k <= 88;
    CHECK(amplitude == doctest::Approx(inside ? rms * std::sqrt(2.0 / 49.0) : 0.0).epsilon(1e-8).scale(1.0));
  }
}

TEST_CASE("a periodic random force repeats itself to rounding, is smooth, and depends on its seeds") {
  const PeriodicRandomForce force(1.0, {0.0, 30.0}, 3.0, 1, 0), same(1.0, {0.0, 30.0}, 3.0, 1, 0);
  const PeriodicRandomForce other(1.0, {0.0, 30.0}, 3.0, 1, 1), another(1.0, {0.0, 30.0}, 3.0, 2, 0);
  double differs = 0.0, differs_too = 0.0;
  for (int n = 0; n < 500; ++n) {
    const double t = 0.0123 * n;
    CHECK(force.at({t, 0.0}) == same.at({t, 0.0}));
    CHECK(std::abs(force.at({t, 0.0}) - force.at({t + 3000.0, 0.0})) < 1e-8);
    // The rest of an instant counts as time, across the end of a period and of a cell, too.
    CHECK(std::abs(force.at({t, 0.004}) - force.at({t + 0.004, 0.0})) < 1e-8);
    differs = std::max(differs, std::abs(force.at({t, 0.0}) - other.at({t, 0.0})));
    differs_too = std::max(differs_too, std::abs(force.at({t, 0.0}) - another.at({t, 0.0})));
  }
  CHECK(differs > 1.0);
  CHECK(differs_too > 1.0);
  for (int cell = 0; cell < 400; ++cell) { // half periods of 30 Hz, over more than two periods
    const double t = cell / 60.0;
    CHECK(std::abs(force.at({t, -1e-12}) - force.at({t, 1e-12})) < 1e-8);
  }
}

TEST_CASE("a chirp with a period begins anew, silent between its sweeps, and tells where it jumps") {
  Scene scene = driven(ExcitationKind::chirp);
  scene.excitation.force = 2.0;
  scene.excitation.start_frequency = 5.0;
  scene.excitation.end_frequency = 9.0;
  scene.excitation.sweep_duration = 2.0;
  scene.excitation.period = 3.0;
  for (const Sweep sweep : {Sweep::linear, Sweep::logarithmic}) {
    scene.excitation.sweep = sweep;
    const auto repeated = make_force_signal(scene);
    Scene once = scene;
    once.excitation.period.reset();
    const auto single = make_force_signal(once);
    for (int n = 1; n < 290; ++n) {
      const double t = 0.01 * n;
      for (const double later : {0.0, 3.0, 300.0})
        CHECK(std::abs(repeated->at({t + later, 0.0}) - single->at({t, 0.0})) < 1e-9);
      CHECK(std::abs(repeated->at({t, 3.0}) - single->at({t, 0.0})) < 1e-9);
    }
    CHECK(repeated->at({5.5, 0.0}) == 0.0);
    CHECK(repeated->at({-0.1, 0.0}) == 0.0);
    double time = -1.0;
    for (const double jump : {0.0, 2.0, 3.0, 5.0, 6.0, 8.0}) CHECK((time = repeated->next_break(time)) == jump);
  }
  scene.excitation.sweep_duration.reset();
  CHECK(make_plan(scene).scene.excitation.sweep_duration == 3.0);
  scene.excitation.period = 0.1; // as many sweeps, whatever the rounding of their ends
  const auto repeated = make_force_signal(scene);
  double time = 0.0;
  for (int n = 1; n <= 1000; ++n) {
    const double jump = repeated->next_break(time);
    CHECK(jump > time);
    if (n % 2 == 0) CHECK(jump < 0.1 * n + 0.01);
    time = jump;
  }
}

TEST_CASE("periods that make no sense are refused with what is allowed") {
  Scene scene = driven(ExcitationKind::random);
  scene.excitation.force_rms = 1.0;
  scene.excitation.band = {10.0, 20.0};
  scene.excitation.period = 8.0;
  CHECK(faults_of(scene).empty());
  for (const double period : {0.1, 0.0, -1.0, 1e6, std::nan(""), std::numeric_limits<double>::infinity()}) {
    CAPTURE(period);
    scene.excitation.period = period;
    CHECK(faults_of(scene).find("excitation.period") != std::string::npos);
  }
  scene = driven(ExcitationKind::chirp);
  scene.excitation.force = 1.0;
  scene.excitation.start_frequency = 5.0;
  scene.excitation.end_frequency = 9.0;
  scene.excitation.sweep_duration = 2.0;
  scene.excitation.period = 1.0;
  CHECK(faults_of(scene).find("excitation.period = 1: shorter than a sweep") != std::string::npos);
  scene.excitation.period = 2.0;
  CHECK(faults_of(scene).empty());
}
