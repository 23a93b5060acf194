// The lists against an all-pairs search at every audited step, in the scenes where lists go wrong.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// 150 granules at rest, the box at 3 m/s from the first step on.
Scene struck_gas() {
  Scene scene = gas(150, 0.03, 0.0, 31);
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.velocity = 3.0;
  scene.time.impact_speed = 6.0;
  scene.time.duration = 6.0e-3;
  use_step(scene, shortest_contact_duration(scene, 6.0) / 8.0);
  return scene;
}

/// Table 5's bed, resting on the floor with the spaces of its lattice, struck sideways at 1 m/s.
Scene struck_bed() {
  Scene scene = table_5(317, 0.02);
  scene.structure.reset();
  scene.excitation = Excitation{};
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.velocity = 1.0;
  scene.excitation.direction = {1.0, 0.0, 0.0};
  use_step(scene, shortest_contact_duration(scene, 2.0) / 8.0);
  return scene;
}

/// `may_stop`: a list that misses a contact lets granules sink into one another or into a wall; a guard may then end
/// the run, and what was counted until then is told.
VerletStatistics audited(Scene scene, ListPolicy policy, bool may_stop = false) {
  scene.verlet.policy = policy;
  scene.verlet.audit = 1;
  SolverRun run(scene);
  try {
    run_all(run, scene);
  } catch (const GuardError& stopped) {
    if (!may_stop) throw;
    MESSAGE("stopped by a guard: ", std::string(stopped.what()));
  }
  return run.simulation().verlet();
}

} // namespace

TEST_CASE("granules at rest in a box that starts at 3 m/s: no policy that guards misses a contact") {
  const Scene scene = struck_gas();
  for (const ListPolicy policy :
       {ListPolicy::guarded, ListPolicy::displacement, ListPolicy::none, ListPolicy::all_pairs}) {
    CAPTURE(static_cast<int>(policy));
    const VerletStatistics seen = audited(scene, policy);
    CHECK(seen.audited >= steps_of(scene));
    CHECK(seen.missed == 0);
    CHECK(seen.missed_pair_steps == 0);
    if (policy == ListPolicy::guarded || policy == ListPolicy::displacement) CHECK(seen.mean_interval > 2.0);
  }
}

TEST_CASE("granules at rest in a box that starts at 3 m/s: the paper's policy misses contacts, and they are counted") {
  const VerletStatistics seen = audited(struck_gas(), ListPolicy::predicted, true);
  MESSAGE("predicted: ", seen.missed, " contacts missed for ", seen.missed_pair_steps, " pair steps");
  CHECK(seen.missed > 0);
  CHECK(seen.missed_pair_steps >= seen.missed);
}

TEST_CASE("a fixed interval that is too long misses contacts, and they are counted") {
  Scene scene = struck_gas();
  scene.verlet.interval = 60;
  scene.verlet.skin = 0.02;
  CHECK(audited(scene, ListPolicy::fixed, true).missed > 0);
  scene.verlet.interval = 1;
  CHECK(audited(scene, ListPolicy::fixed).missed == 0);
}

TEST_CASE("Table 5's bed struck sideways at 1 m/s: guarded and displacement miss nothing") {
  const Scene scene = struck_bed();
  for (const ListPolicy policy : {ListPolicy::guarded, ListPolicy::displacement}) {
    CAPTURE(static_cast<int>(policy));
    const VerletStatistics seen = audited(scene, policy);
    CHECK(seen.audited >= steps_of(scene));
    CHECK(seen.missed == 0);
  }
}

TEST_CASE("every policy that misses nothing gives the same motion, to rounding") {
  Scene scene = struck_gas();
  scene.time.duration = 1.5e-3;
  use_step(scene, *scene.time.step);
  OracleRun oracle(scene);
  run_all(oracle, scene);
  const GranuleTable expected = oracle.granules();
  for (const ListPolicy policy :
       {ListPolicy::guarded, ListPolicy::displacement, ListPolicy::none, ListPolicy::all_pairs}) {
    for (const double skin : {0.02, 0.1, 0.5}) {
      CAPTURE(static_cast<int>(policy));
      CAPTURE(skin);
      scene.verlet.policy = policy;
      scene.verlet.skin = skin;
      SolverRun run(scene);
      run_all(run, scene);
      const GranuleTable got = run.granules();
      double error = 0.0;
      for (std::size_t i = 0; i < got.position.size(); ++i)
        error = std::max(error, length(difference(got.position[i], expected.position[i])) / got.radius[i]);
      CHECK(error < 1.0e-9);
    }
  }
}
