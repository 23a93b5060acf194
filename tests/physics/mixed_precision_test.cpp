// Mixed precision: what float does to conservation, restitution and a damper's figures, held against double.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

using namespace grandamp;
using namespace grandamp::test;

namespace {

Scene in_mixed(Scene scene) {
  scene.time.precision = Precision::mixed;
  return scene;
}

Vector3 momentum(const GranuleTable& granules, const std::vector<double>& masses, double* scale = nullptr) {
  Vector3 sum{};
  for (std::size_t i = 0; i < masses.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += masses[i] * granules.velocity[i][k];
    if (scale != nullptr) *scale += masses[i] * length(granules.velocity[i]);
  }
  return sum;
}

double restitution(const Scene& scene, double closing) {
  SolverRun run(scene);
  run_all(run, scene);
  const GranuleTable end = run.granules();
  return length(difference(end.velocity[1], end.velocity[0])) / closing;
}

/// Figures of a damper's run that do not depend on how its granules happen to lie.
struct Figures {
  double rms = 0.0, peak = 0.0, work_in = 0.0, normal = 0.0, friction = 0.0;
  static constexpr std::array names{"rms displacement", "peak displacement", "work put in", "lost along normals",
                                    "lost in friction"};
  std::array<double, 5> values() const { return {rms, peak, work_in, normal, friction}; }
};

Figures figures(const Scene& scene) {
  SolverRun run(scene);
  run_all(run, scene);
  const Ledger ledger = run.sample().ledger;
  const ResponseStatistics response = run.simulation().response();
  return {response.rms_displacement, response.peak_displacement, ledger.work_in,
          ledger.normal_granule + ledger.normal_wall, ledger.friction_granule + ledger.friction_wall};
}

} // namespace

TEST_CASE("mixed precision: momentum is kept to rounding in double, for a force and its opposite are one number") {
  for (const bool several : {false, true}) {
    CAPTURE(several);
    Scene scene = in_mixed(imploding_cluster(60, 3));
    Population& population = scene.populations[0];
    population.masses.assign(60, population.mass);
    if (several) {
      population.radii.assign(60, population.radius);
      for (std::size_t i = 0; i < 60; ++i) {
        population.radii[i] *= 0.6 + 0.4 * static_cast<double>(i % 3) / 2.0;
        population.masses[i] = sphere_mass(population.radii[i], i % 2 ? 1190.0 : 7800.0);
      }
    }
    scene.time.duration = 8.0e-3;
    use_step(scene, 2.0e-6);
    SolverRun run(scene);
    double scale = 0.0, drift = 0.0;
    std::int64_t contacts = 0;
    const Vector3 start = momentum(run.granules(), population.masses, &scale);
    for (std::int64_t n = 0; n < steps_of(scene); ++n) {
      run.step();
      if (n % 100 != 99) continue;
      contacts += run.sample().contacts;
      drift = std::max(drift, length(difference(momentum(run.granules(), population.masses), start)) / scale);
    }
    CHECK(contacts > 10);
    CHECK(drift < 1.0e-13);
  }
}

TEST_CASE("mixed precision: restitution at T_c/8 is that of double, phase by phase") {
  for (int phase = 0; phase < 50; ++phase) {
    Scene scene = two_granules(1.5e-3, 2.5, 0.0);
    const double step = pair_contact_duration(scene, 5.0) / 8.0;
    scene = two_granules(1.5e-3, 2.5, 5.0 * step * (1.0 + (phase + 0.5) / 50), {2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0});
    use_step(scene, step);
    CHECK(std::abs(restitution(in_mixed(scene), 5.0) - restitution(scene, 5.0)) < 2.0e-6);
  }
}

TEST_CASE("mixed precision: an elastic, frictionless gas keeps its energy as it does in double") {
  const auto worst = [](Scene scene) {
    SolverRun run(scene);
    const double first = run.sample().stored.kinetic;
    double largest = 0.0;
    for (std::int64_t n = 0; n < steps_of(scene); ++n) {
      run.step();
      if (n % 20) continue;
      const StoredEnergy now = run.sample().stored;
      largest = std::max(largest, std::abs((now.kinetic + now.elastic) / first - 1.0));
    }
    return largest;
  };
  Scene scene = gas(150, 0.024, 2.5, 12);
  make_lossless(scene);
  scene.time.duration = full_tests() ? 0.05 : 8.0e-3;
  use_step(scene, shortest_contact_duration(scene, 5.0) / 8.0);
  const double full = worst(scene), mixed = worst(in_mixed(scene));
  MESSAGE("energy moves by ", 100.0 * full, " % in double, ", 100.0 * mixed, " % in mixed precision");
  CHECK(mixed < 0.01);
  // With steps so small that the integrator's error is gone, what float makes of the law is left.
  scene = gas(30, 0.012, 2.5, 12);
  make_lossless(scene);
  scene.time.duration = 1.0e-3;
  use_step(scene, shortest_contact_duration(scene, 5.0) / 400.0);
  const double fine_full = worst(scene), fine_mixed = worst(in_mixed(scene));
  MESSAGE("at T_c/400 by ", fine_full, " and ", fine_mixed, " of itself");
  CHECK(fine_mixed < 2.0 * fine_full + 1.0e-5);
}

TEST_CASE("mixed precision: Table 5's damper has the figures of double within the scatter of chaotic runs") {
  const int runs = full_tests() ? 12 : 6;
  std::array<std::array<double, 5>, 2> sum{}, squares{};
  for (int r = 0; r < runs; ++r) {
    Scene scene = table_5(317, full_tests() ? 2.0 : 0.5);
    use_step(scene, shortest_contact_duration(scene, 2.0) / 8.0);
    std::mt19937_64 engine(100 + static_cast<unsigned>(r));
    std::uniform_real_distribution<double> nudge(-1.0e-6, 1.0e-6);
    for (Vector3& position : scene.populations[0].positions)
      for (double& component : position) component += nudge(engine);
    for (const bool mixed : {false, true}) {
      const std::array<double, 5> values = figures(mixed ? in_mixed(scene) : scene).values();
      for (std::size_t k = 0; k < values.size(); ++k) {
        sum[mixed][k] += values[k];
        squares[mixed][k] += values[k] * values[k];
      }
    }
  }
  for (std::size_t k = 0; k < Figures::names.size(); ++k) {
    const auto mean = [&](int which) { return sum[static_cast<std::size_t>(which)][k] / runs; };
    const auto variance = [&](int which) { // of the mean
      return (squares[static_cast<std::size_t>(which)][k] / runs - mean(which) * mean(which)) / (runs - 1);
    };
    const double error = std::sqrt(variance(0) + variance(1));
    MESSAGE(std::string(Figures::names[k]), ": ", mean(0), " in double, ", mean(1), " mixed, standard error ", error);
    CHECK(std::abs(mean(1) - mean(0)) < 4.0 * error);
    CHECK(error < 0.1 * mean(0)); // or the comparison says nothing
  }
}
