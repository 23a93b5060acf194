// Momentum, angular momentum and energy where nothing outside takes part.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

using namespace grandamp;
using namespace grandamp::test;

namespace {

struct Momenta {
  Vector3 linear{}, angular{}; ///< angular: about the centre of mass, spins included
  double linear_scale = 0.0, angular_scale = 0.0;
};

Momenta momenta(const GranuleTable& granules, const std::vector<double>& masses) {
  Momenta all;
  Vector3 centre{};
  double total = 0.0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    total += masses[i];
    for (std::size_t k = 0; k < 3; ++k) {
      centre[k] += masses[i] * granules.position[i][k];
      all.linear[k] += masses[i] * granules.velocity[i][k];
    }
    all.linear_scale += masses[i] * length(granules.velocity[i]);
  }
  for (double& component : centre) component /= total;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vector3 orbital = cross(difference(granules.position[i], centre), granules.velocity[i]);
    const double inertia = 0.4 * masses[i] * granules.radius[i] * granules.radius[i];
    for (std::size_t k = 0; k < 3; ++k) all.angular[k] += masses[i] * orbital[k] + inertia * granules.spin[i][k];
    all.angular_scale += masses[i] * length(orbital) + inertia * length(granules.spin[i]);
  }
  return all;
}

struct Allowance {
  double during = 0.0; ///< largest rise of kinetic and elastic energy together at any step of a contact
  double after = 0.0;  ///< and once it is over
};

/// The integrator's own error on energy: an elastic, frictionless head-on hit at T_c/8, the worst of many phases of
/// entry, over the energy at the start.
template <class Run> Allowance energy_allowance(Integrator integrator) {
  Allowance worst;
  for (int p = 0; p < 40; ++p) {
    Scene scene = two_granules(1.5e-3, 2.5, 0.0);
    const double step = pair_contact_duration(scene, 5.0) / 8.0;
    scene = two_granules(1.5e-3, 2.5, 5.0 * step * (1.0 + p / 40.0));
    make_lossless(scene);
    scene.time.integrator = integrator;
    use_step(scene, step);
    Run run(scene);
    const double first = run.sample().stored.kinetic;
    for (std::int64_t n = steps_of(scene); n >= 0; --n) {
      const StoredEnergy now = run.sample().stored;
      const double rise = (now.kinetic + now.elastic) / first - 1.0;
      worst.during = std::max(worst.during, rise);
      if (n == 0) worst.after = std::max(worst.after, rise);
      if (n > 0) run.step();
    }
  }
  return worst;
}

} // namespace

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
