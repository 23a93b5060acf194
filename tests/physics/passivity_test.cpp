// One granule held by many others and spun: several friction caps act on it at once, and must not feed it energy.
#include "tests/support/held_granule.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <random>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// Largest rise of the held granule's kinetic energy from one step to the next, over its first.
template <class Run> double largest_rise(const Scene& scene, double* left = nullptr) {
  const double mass = scene.populations[0].masses[0], radius = scene.populations[0].radii[0];
  Run run(scene);
  const auto energy = [&] {
    const GranuleTable now = run.granules();
    return 0.5 * mass * dot(now.velocity[0], now.velocity[0]) +
           0.2 * mass * radius * radius * dot(now.spin[0], now.spin[0]);
  };
  const double first = energy();
  double before = first, rise = 0.0;
  for (std::int64_t n = steps_of(scene); n > 0; --n) {
    run.step();
    const double now = energy();
    rise = std::max(rise, (now - before) / first);
    before = now;
  }
  if (left) *left = before / first;
  return rise;
}

} // namespace

TEST_CASE_TEMPLATE("a granule held by 3, 4, 6 and 12 others on its equator and spun never gains kinetic energy", Run,
                   OracleRun, SolverRun) {
  for (const int count : {3, 4, 6, 12}) {
    CAPTURE(count);
    double left = 0.0;
    CHECK(largest_rise<Run>(held(ring(count), {0.0, 0.0, 50.0}, 10.0), &left) < 1.0e-9); // the caps rule
    CHECK(left < 1.0e-3);
    CHECK(largest_rise<Run>(held(ring(count), {0.0, 0.0, 2000.0}, 0.1)) < 1.0e-9); // Coulomb's law rules
  }
}

TEST_CASE_TEMPLATE("a granule held by 4, 6 and 12 others all around and spun about any axis never gains kinetic energy",
                   Run, OracleRun, SolverRun) {
  for (const int count : {4, 6, 12})
    for (const Vector3& spin : {Vector3{50.0, 0.0, 0.0}, Vector3{10.0, -30.0, 20.0}, Vector3{0.0, 3.0, 50.0}}) {
      CAPTURE(count);
      double left = 0.0;
      CHECK(largest_rise<Run>(held(all_around(count), spin, 10.0), &left) < 1.0e-9);
      CHECK(left < 1.0e-3);
    }
}

TEST_CASE_TEMPLATE("a granule at rest on one wall and spun never gains kinetic energy", Run, OracleRun, SolverRun) {
  const double radius = 1.5e-3, g = 9.81;
  const double sunk = std::pow(sphere_mass(radius) * g / (1.3e7 * std::sqrt(radius / 3.0e-3)), 2.0 / 3.0);
  for (const double spin : {1.0, 30.0, 1000.0}) {
    CAPTURE(spin);
    Scene scene = granule_and_floor(radius, -sunk, {}, {0.0, spin, 0.3 * spin});
    scene.gravity = {0.0, 0.0, -g};
    scene.time.impact_speed = 1.0;
    scene.time.duration = 5.0e-3;
    use_step(scene, wall_contact_duration(scene, 1.0) / 8.0);
    scene.populations[0].radii = {radius};
    scene.populations[0].masses = {scene.populations[0].mass};
    CHECK(largest_rise<Run>(scene) < 1.0e-9);
  }
}
