// Momentum, angular momentum and energy where nothing outside takes part.
#include "tests/support/energy_allowance.hpp"
#include "tests/support/momenta.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE_TEMPLATE("momentum and angular momentum are conserved to rounding, whatever the contacts do", Run, OracleRun,
                   SolverRun) {
  for (const bool mixed : {false, true}) {
    CAPTURE(mixed);
    Scene scene = imploding_cluster(60, 3);
    Population& population = scene.populations[0];
    population.masses.assign(60, population.mass);
    if (mixed) {
      population.radii.assign(60, population.radius);
      for (std::size_t i = 0; i < 60; ++i) {
        population.radii[i] *= 0.6 + 0.4 * static_cast<double>(i % 3) / 2.0;
        population.masses[i] = sphere_mass(population.radii[i], i % 2 ? 1190.0 : 7800.0);
      }
    }
    scene.time.duration = 8.0e-3;
    use_step(scene, 2.0e-6);
    Run run(scene);
    const Momenta start = momenta(run.granules(), population.masses);
    double drift = 0.0, turn = 0.0;
    std::int64_t contacts = 0;
    for (std::int64_t n = 0; n < steps_of(scene); ++n) {
      run.step();
      if (n % 100 != 99) continue;
      contacts += run.sample().contacts;
      const Momenta now = momenta(run.granules(), population.masses);
      drift = std::max(drift, length(difference(now.linear, start.linear)) / start.linear_scale);
      turn = std::max(turn, length(difference(now.angular, start.angular)) / start.angular_scale);
    }
    CHECK(contacts > 10);
    CHECK(drift < 1.0e-13);
    CHECK(turn < 1.0e-11); // positions are rounded on the scale of the box, ten times the cluster's
  }
}

TEST_CASE_TEMPLATE("an elastic hit at T_c/8 gains under one percent of its energy and borrows under three", Run,
                   OracleRun, SolverRun) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    const Allowance allowance = energy_allowance<Run>(integrator);
    MESSAGE(std::string(integrator == Integrator::leapfrog ? "leapfrog" : "verlet"),
            " at T_c/8, one elastic hit: energy rises by ", 100.0 * allowance.after, " % at most, by ",
            100.0 * allowance.during, " % while it lasts");
    CHECK(allowance.after < 0.01);
    CHECK(allowance.during < 0.03);
  }
}

TEST_CASE_TEMPLATE("energy never rises in a closed box beyond the integrator's error on one contact", Run, OracleRun,
                   SolverRun) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Scene scene = gas(150, 0.024, 2.5, 11);
    scene.time.integrator = integrator;
    scene.time.duration = full_tests() ? 0.05 : 8.0e-3;
    use_step(scene, shortest_contact_duration(scene, 5.0) / 8.0);
    const double allowance = energy_allowance<Run>(integrator).during;
    Run run(scene);
    double least = run.sample().stored.kinetic, first = least, rise = 0.0;
    for (std::int64_t n = 0; n < steps_of(scene); ++n) {
      run.step();
      if (n % 4) continue;
      const StoredEnergy now = run.sample().stored;
      const double energy = now.kinetic + now.elastic;
      rise = std::max(rise, energy / least - 1.0);
      least = std::min(least, energy);
    }
    CHECK(least < 0.5 * first);
    CHECK(rise <= allowance);
  }
}

TEST_CASE_TEMPLATE("an elastic, frictionless gas keeps its energy", Run, OracleRun, SolverRun) {
  Scene scene = gas(150, 0.024, 2.5, 12);
  make_lossless(scene);
  scene.time.duration = full_tests() ? 0.05 : 8.0e-3;
  use_step(scene, shortest_contact_duration(scene, 5.0) / 8.0);
  Run run(scene);
  const double first = run.sample().stored.kinetic;
  double largest = 0.0;
  for (std::int64_t n = 0; n < steps_of(scene); ++n) {
    run.step();
    if (n % 20) continue;
    const StoredEnergy now = run.sample().stored;
    largest = std::max(largest, std::abs((now.kinetic + now.elastic) / first - 1.0));
  }
  CHECK(largest < 0.01);
}
