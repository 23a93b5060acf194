// Contacts that only push: the restitution that the scene asks for, the friction that goes with it, and what contacts
// that may pull make of the same.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double radius = 1.5e-3;
constexpr double speed = 0.1;

Scene hit(double restitution, double tangential_speed, double friction, bool tension, double steps_per_contact) {
  Scene scene = granule_and_floor(radius, 1.0e-9, {tangential_speed, 0.0, -speed});
  scene.contact.tension = tension;
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    constants->alpha.reset();
    constants->restitution = restitution;
    constants->friction = friction;
  }
  // A strongly damped granule takes its time to leave.
  scene.time.duration *= restitution < 0.2 ? 5.0 : 2.0;
  use_step(scene, wall_contact_duration(scene, speed) / steps_per_contact);
  return scene;
}

template <class Run> GranuleTable after(const Scene& scene) {
  Run run(scene);
  run_all(run, scene);
  return run.granules();
}

} // namespace

TEST_CASE_TEMPLATE("without tension the restitution is what the scene says, at any speed", Run, OracleRun, SolverRun) {
  for (const double e : {0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.89, 0.95, 1.0}) {
    CAPTURE(e);
    CHECK(std::abs(after<Run>(hit(e, 0.0, 0.0, false, 4000.0)).velocity[0][2] / speed - e) < 1.0e-3);
  }
}

TEST_CASE("without tension at the step that a scene gets by itself") {
  for (const double e : {0.05, 0.2, 0.5, 0.89}) {
    Scene scene = hit(e, 0.0, 0.0, false, 8.0);
    scene.time.step.reset();
    scene.time.impact_speed = speed;
    double mean = 0.0;
    const int phases = 40;
    for (int k = 0; k < phases; ++k) {
      scene.populations[0].positions[0][2] = radius + 1.0e-9 + speed * 5.0e-6 * k / phases;
      Simulation run(scene);
      while (!run.finished()) run.step();
      mean += run.granules().velocity[0][2] / speed / phases;
    }
    MESSAGE("e = " << e << ": " << mean << " on average over the phases of entry at the default step");
    CHECK(mean == doctest::Approx(e).epsilon(0.04));
  }
}

TEST_CASE_TEMPLATE("sliding takes mu (1 + e) of the normal speed without tension, and more with it", Run, OracleRun,
                   SolverRun) {
  const double tangential = 0.5, mu = 0.1;
  for (const double e : {0.05, 0.3, 0.5, 0.9}) {
    CAPTURE(e);
    const auto lost = [&](bool tension) {
      return (tangential - after<Run>(hit(e, tangential, mu, tension, 4000.0)).velocity[0][0]) / speed;
    };
    CHECK(lost(false) == doctest::Approx(mu * (1.0 + e)).epsilon(5.0e-3));
    if (e == 0.5) CHECK(lost(true) == doctest::Approx(1.067 * mu * (1.0 + e)).epsilon(5.0e-3));
  }
}

TEST_CASE("linear damping without tension pushes the granule off sooner, and it keeps more speed") {
  const auto rebound = [](bool tension) {
    Scene scene = hit(0.5, 0.0, 0.0, tension, 1000.0);
    scene.contact.damping = NormalDamping::linear;
    for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
      constants->restitution.reset();
      constants->normal_damping = 0.05;
    }
    return after<SolverRun>(scene).velocity[0][2] / speed;
  };
  const double pulled = rebound(true), pushed = rebound(false);
  CHECK(pushed > pulled + 1.0e-3);
  CHECK(pushed < 1.0);
}

TEST_CASE("two populations have the restitution of their own pair, and of their own wall") {
  Scene scene = two_granules(radius, speed, 1.0e-7);
  scene.populations.push_back(scene.populations[0]);
  Population &a = scene.populations[0], &b = scene.populations[1];
  a.name.assign(1, 'a');
  b.name.assign(1, 'b');
  for (auto member : {&Population::positions, &Population::velocities, &Population::spins}) {
    (a.*member).resize(1);
    (b.*member).erase((b.*member).begin());
  }
  a.count = b.count = 1;
  PairContact own{{"b", "a"}, scene.contact.granule};
  own.constants.alpha.reset();
  own.constants.restitution = 0.4;
  scene.contact.pairs.push_back(own);
  use_step(scene, pair_contact_duration(scene, 2.0 * speed) / 1000.0);
  CHECK(-after<SolverRun>(scene).velocity[0][0] / speed == doctest::Approx(0.4).epsilon(1.0e-3));

  Scene floor = hit(0.9, 0.0, 0.0, true, 1000.0);
  floor.populations[0].name.assign(1, 'a');
  PairContact wall{{"a", "wall"}, *floor.contact.wall};
  wall.constants.restitution = 0.3;
  floor.contact.pairs.push_back(wall);
  CHECK(after<SolverRun>(floor).velocity[0][2] / speed == doctest::Approx(0.3).epsilon(1.0e-3));
}
