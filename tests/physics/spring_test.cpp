// Friction with a memory: it never makes energy, it stores and gives back, it forgets what has parted, and it does not
// mind how and when the list is built.
#include "kernels/reference.hpp"
#include "tests/support/hits.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <numbers>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double radius = Hits::radius;

} // namespace

TEST_CASE("energy never rises in a hit: 90 angles, any friction and restitution, both laws, sizes apart") {
  // What leapfrog itself may add at eight steps a contact, measured on elastic head-on hits over the phases of entry.
  double allowance = 0.0;
  for (int phase = 0; phase < 60; ++phase) {
    Scene scene = granule_and_floor(radius, 2.0e-7 + 2.0e-7 * phase, {0.0, 0.0, -2.0});
    make_lossless(scene);
    use_step(scene, wall_contact_duration(scene, 2.0) / 8.0);
    SolverRun run(scene);
    run_all(run, scene);
    const double v = run.granules().velocity[0][2];
    allowance = std::max(allowance, v * v / 4.0 - 1.0);
  }
  MESSAGE("a lossless head-on hit gains up to " << allowance);
  CHECK(allowance < 0.012);
  const std::vector<double> restitutions =
      full_tests() ? std::vector{0.05, 0.3, 0.6, 0.9, 1.0} : std::vector{0.05, 1.0};
  const std::vector<double> frictions =
      full_tests() ? std::vector{0.0, 0.1, 0.3, 0.52, 1.0, 2.0} : std::vector{0.0, 0.1, 0.52, 2.0};
  double worst = -1.0;
  for (const FrictionLaw law : {FrictionLaw::coulomb, FrictionLaw::spring})
    for (const double ratio : {0.0, 1.0, 3.0, 10.0})
      for (const double restitution : restitutions)
        for (const double friction : frictions)
          for (const double damping : {0.0, 0.02}) {
            if (law == FrictionLaw::coulomb && damping > 0.0) continue;
            CAPTURE(static_cast<int>(law));
            CAPTURE(ratio);
            CAPTURE(restitution);
            CAPTURE(friction);
            CAPTURE(damping);
            Hits hits(ratio, restitution, friction);
            if (law == FrictionLaw::spring) put_on_springs(hits.scene, 0.9, damping);
            SolverRun run(hits.scene);
            const std::vector<double> before = energies(hits, run.granules());
            run_all(run, hits.scene);
            REQUIRE(run.sample().contacts == 0);
            const std::vector<double> after = energies(hits, run.granules());
            for (int n = 0; n < Hits::angles; ++n) {
              const auto k = static_cast<std::size_t>(n);
              worst = std::max(worst, after[k] / before[k] - 1.0);
              if (after[k] > before[k] * (1.0 + allowance))
                FAIL_CHECK(n << " degrees: gains " << after[k] / before[k] - 1.0);
            }
          }
  MESSAGE("the worst of all hits gains " << worst);
}

TEST_CASE("a spring contact loaded and unloaded at fixed slip gives no work") {
  reference::Law law;
  law.stiffness_coefficient = 2.6e8;
  law.tangential_stiffness_coefficient = 2.3e8;
  law.friction = 10.0; // it never slides
  law.spring = true;
  const double step = 1.0e-7;
  // Overlap and slip are led round a loop: little overlap, slip, much overlap, slip back, little overlap; and the other
  // way round. The work that the contact takes must not be negative.
  for (const bool forward : {true, false}) {
    reference::Spring spring;
    double work = 0.0, stored = 0.0, least = 0.0;
    const int steps = 400;
    for (int turn = 0; turn < 5; ++turn)
      for (int side = 0; side < 4; ++side) {
        const int leg = forward ? side : 3 - side, sign = forward ? 1 : -1;
        for (int n = 0; n < steps; ++n) {
          const double share = (n + 0.5) / steps, way = forward ? share : 1.0 - share;
          const double overlap = leg == 0 ? 1e-5 : leg == 1 ? 1e-5 + 3e-5 * way : leg == 2 ? 4e-5 : 4e-5 - 3e-5 * way;
          const double slip = leg == 0 ? 0.02 : leg == 2 ? -0.02 : 0.0;
          reference::Granule granule;
          granule.radius = radius;
          granule.mass = 1.7e-5;
          granule.velocity = {sign * slip, 0.0, 0.0};
          const reference::Contact contact = reference::wall_contact(granule, radius - overlap, {0.0, 0.0, -1.0}, law,
                                                                     step, granule.mass, granule.mass, spring);
          // The force that the slip meets is that between the step's ends.
          work -= 0.5 * (contact.memory.force[0] + spring.force[0]) * granule.velocity[0] * step;
          spring = contact.memory;
          stored = contact.spring_energy;
          least = std::min(least, work - stored);
        }
      }
    CAPTURE(forward);
    CHECK(least > -1.0e-15);
    CHECK(work - stored > 1.0e-12); // and a loop does cost something
  }
}

TEST_CASE("a contact that does not slide swings like a spring and gives nearly everything back") {
  // Rolling and normal motion apart, the tangential spring turns the slip round: the surface leaves with speed the
  // other way, which friction without a memory can never do.
  Scene scene = granule_and_floor(radius, 1.0e-9, {0.02, 0.0, -1.0});
  set_losses(scene, 1.0, 100.0);
  put_on_springs(scene);
  use_step(scene, wall_contact_duration(scene, 1.0) / 400.0);
  SolverRun run(scene);
  const double before = run.sample().stored.kinetic;
  run_all(run, scene);
  const GranuleTable end = run.granules();
  const double slip = end.velocity[0][0] - radius * end.spin[0][1];
  CHECK(slip < -0.001);
  CHECK(run.sample().stored.kinetic <= before);
  CHECK(run.sample().stored.elastic == 0.0);
}

TEST_CASE_TEMPLATE("the ledger closes with springs, and friction only takes", Run, OracleRun, SolverRun) {
  for (const double friction : {0.1, 0.5}) {
    Scene scene = imploding_cluster(25, 3);
    set_losses(scene, 0.8, friction);
    put_on_springs(scene, 0.8, 0.01);
    scene.time.duration = 3.0e-3;
    use_step(scene, shortest_contact_duration(scene, 5.0) / 24.0);
    Run run(scene);
    const Sample start = run.sample();
    double lost = 0.0, most = 0.0;
    for (std::int64_t n = steps_of(scene); n > 0; --n) {
      const Sample now = run.step_and_sample();
      CHECK(now.ledger.friction_granule >= lost - 2.0e-4 * start.stored.kinetic);
      lost = now.ledger.friction_granule;
      most = std::max(most, now.stored.elastic);
    }
    const Sample end = run.sample();
    CHECK(most > 0.0);
    CHECK(end.ledger.friction_granule > 0.01 * start.stored.kinetic);
    CHECK(std::abs(ledger_residual(start, end)) < 5.0e-3);
  }
}

TEST_CASE("a spring's history survives sorts and rebuilds: the same bits whatever the list") {
  // 40 pairs and 20 granules on the floor, each in one contact, so that sums have one order; contacts last hundreds of
  // steps, and all fly across the cells on the way.
  Scene scene = box_scene(0.12, radius);
  for (int n = 0; n < 60; ++n) {
    const double x = 0.01 + 0.011 * (n % 10), y = 0.01 + 0.011 * (n / 10 % 4), angle = 0.2 + 0.1 * (n % 12);
    const double dx = std::sin(angle), dz = std::cos(angle), along = n % 2 ? 4.0 : -4.0;
    if (n >= 40) {
      add_granule(scene, {x, 0.06 + y, radius + 1e-8}, {0.8 * along, 1.0, -0.7}, {30.0, 200.0, -50.0});
      continue;
    }
    const double z = 0.03 + 0.012 * (n % 6), apart = 2.0 * radius + 1e-8;
    add_granule(scene, {x, y, z}, {along + 0.5, 3.0 + 0.4, 0.2}, {100.0, -50.0, 20.0});
    add_granule(scene, {x + apart * dx, y, z + apart * dz}, {along - 0.5 * dx, 3.0, 0.2 - 0.9 * dz});
  }
  set_losses(scene, 0.6, 0.4);
  put_on_springs(scene, 0.9, 0.01);
  scene.time.impact_speed = 10.0;
  scene.time.duration = 4.0e-4;
  use_step(scene, 2.0e-7);
  const auto run = [&](ListPolicy policy, int interval, double skin, Integrator integrator, std::int64_t* builds) {
    scene.verlet.policy = policy;
    scene.verlet.interval = interval;
    scene.verlet.skin.reset();
    if (skin > 0.0) scene.verlet.skin = skin;
    scene.time.integrator = integrator;
    SolverRun one(scene);
    std::int64_t contacts = 0;
    for (std::int64_t n = steps_of(scene); n > 0; --n) contacts += one.step_and_sample().contacts;
    CHECK(contacts > 5000);
    *builds = one.simulation().verlet().builds;
    return one.granules();
  };
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    std::int64_t never = 0, builds = 0;
    const GranuleTable expected = run(ListPolicy::guarded, 1, 0.8, integrator, &never);
    CHECK(never < 10);
    for (const auto& [policy, interval, skin] : {std::tuple{ListPolicy::fixed, 7, 0.2},
                                                 {ListPolicy::guarded, 1, 0.01},
                                                 {ListPolicy::none, 1, 0.0},
                                                 {ListPolicy::all_pairs, 1, 0.0}}) {
      CAPTURE(static_cast<int>(policy));
      const GranuleTable now = run(policy, interval, skin, integrator, &builds);
      CHECK(builds > 50);
      CHECK(now.position == expected.position);
      CHECK(now.velocity == expected.velocity);
      CHECK(now.spin == expected.spin);
    }
  }
}

TEST_CASE("a contact that has parted is a fresh one when it comes again") {
  // A granule bounces twice; the second hit must be that of one which starts there with the same motion.
  Scene scene = granule_and_floor(radius, 1.0e-8, {0.5, 0.0, -1.0});
  set_losses(scene, 0.9, 0.3);
  put_on_springs(scene);
  scene.gravity = {0.0, 0.0, -2000.0};
  scene.verlet.skin = 0.8; // one list for both hits
  scene.time.duration = 2.2e-3;
  use_step(scene, wall_contact_duration(scene, 1.0) / 50.0);
  SolverRun run(scene);
  bool touched = false, parted = false;
  while (!(touched && parted)) {
    const bool now = run.step_and_sample().contacts > 0;
    parted = touched && !now;
    touched = touched || now;
  }
  while (run.granules().velocity[0][2] > 0.0) run.step();
  const GranuleTable there = run.granules();
  Scene again = scene;
  Population& granule = again.populations[0];
  granule.positions = there.position;
  granule.velocities = there.velocity;
  granule.spins = there.spin;
  SolverRun fresh(again);
  for (int n = 0; n < 200; ++n) {
    run.step();
    fresh.step();
  }
  const GranuleTable a = run.granules(), b = fresh.granules();
  CHECK(a.velocity[0][0] == doctest::Approx(b.velocity[0][0]).epsilon(1.0e-9));
  CHECK(a.spin[0][1] == doctest::Approx(b.spin[0][1]).epsilon(1.0e-9));
}
