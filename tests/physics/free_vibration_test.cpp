// What a free vibration tells of its damping: the bare structure in closed form, and with granules in a closed ledger.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <numbers>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE("the bare structure loses what its damping ratio says, cycle by cycle") {
  Scene scene = bare_structure();
  scene.excitation = {};
  scene.structure->displacement = 0.01;
  scene.time.duration = 2.0;
  SolverRun run(scene);
  while (!run.simulation().finished()) run.step();
  const Structure& s = *scene.structure;
  const double zeta = s.damping / (2.0 * std::sqrt(s.mass * s.stiffness));
  const double capacity = 1.0 - std::exp(-4.0 * std::numbers::pi * zeta / std::sqrt(1.0 - zeta * zeta));
  const std::vector<VibrationCycle> cycles = run.simulation().response().cycles;
  REQUIRE(cycles.size() > 25);
  for (const VibrationCycle& cycle : cycles) {
    CHECK(cycle.specific_damping_capacity == doctest::Approx(capacity).epsilon(1.0e-4));
    CHECK(cycle.damping_ratio == doctest::Approx(zeta).epsilon(1.0e-4));
  }
}

TEST_CASE("granules damp a free vibration beyond the structure's own damping") {
  Scene scene = table_5(60, 0.5);
  scene.excitation = {};
  scene.structure->displacement = 0.0157;
  SolverRun run(scene);
  while (!run.simulation().finished()) run.step();
  const ResponseStatistics response = run.simulation().response();
  REQUIRE(response.cycles.size() > 3);
  const Structure& s = *scene.structure;
  const double zeta = s.damping / (2.0 * std::sqrt(s.mass * s.stiffness));
  double mean = 0.0, energy = 1.0;
  for (const VibrationCycle& cycle : response.cycles) {
    mean += cycle.damping_ratio / static_cast<double>(response.cycles.size());
    energy *= 1.0 - cycle.specific_damping_capacity;
  }
  MESSAGE(response.cycles.size() << " cycles, damping ratio " << mean << " against the bare structure's " << zeta);
  CHECK(mean > 1.5 * zeta);
  // The capacities are those of the peaks that they lie between.
  const VibrationCycle &first = response.cycles.front(), &last = response.cycles.back();
  CHECK(last.peak_kinetic_energy * (1.0 - last.specific_damping_capacity) ==
        doctest::Approx(first.peak_kinetic_energy * energy).epsilon(1.0e-12));
}

TEST_CASE("a forced vibration has no cycles of its own") {
  Scene scene = bare_structure();
  scene.time.duration = 1.0;
  scene.excitation.frequency = 15.91;
  SolverRun run(scene);
  for (int k = 0; k < 2000; ++k) run.step();
  CHECK(run.simulation().response().cycles.empty());
}
