// Friction and spin on one contact: sliding, sticking, the 5/7 rule, and what the friction's cap leaves of it at a
// coarse step.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double radius = 1.5e-3;
constexpr double normal_speed = 0.01; // so slow that the overlap, and with it the shortening of the arm, is 1e-4 of r

Scene oblique_floor_hit(double tangential_speed, double friction, double steps_per_contact) {
  Scene scene = granule_and_floor(radius, 1.0e-9, {tangential_speed, 0.0, -normal_speed});
  scene.contact.damping = NormalDamping::none;
  scene.contact.granule.alpha.reset();
  scene.contact.wall->alpha.reset();
  scene.contact.wall->friction = friction;
  use_step(scene, wall_contact_duration(scene, normal_speed) / steps_per_contact);
  return scene;
}

} // namespace

TEST_CASE_TEMPLATE("sliding on a wall takes mu (1 + e) v_n of speed and gives 5/2 of it as spin", Run, OracleRun,
                   SolverRun) {
  const double tangential = 0.05, mu = 0.1;
  const Scene scene = oblique_floor_hit(tangential, mu, 1000.0);
  Run run(scene);
  run_all(run, scene);
  const GranuleTable end = run.granules();
  const double lost = mu * 2.0 * normal_speed;
  CHECK(end.velocity[0][0] == doctest::Approx(tangential - lost).epsilon(1.0e-5));
  CHECK(end.velocity[0][2] == doctest::Approx(normal_speed).epsilon(1.0e-4));
  // Friction on the bottom of a granule going +x points to -x: the granule rolls forward, about +y.
  CHECK(end.spin[0][1] * radius == doctest::Approx(2.5 * lost).epsilon(1.0e-3));
  CHECK(std::abs(end.spin[0][0]) + std::abs(end.spin[0][2]) + std::abs(end.velocity[0][1]) < 1.0e-15);
}

TEST_CASE_TEMPLATE("sticking on a wall leaves 5/7 of the tangential speed, rolling", Run, OracleRun, SolverRun) {
  const double tangential = 0.005;
  const Scene scene = oblique_floor_hit(tangential, 1.0, 1000.0);
  Run run(scene);
  run_all(run, scene);
  const GranuleTable end = run.granules();
  CHECK(end.velocity[0][0] == doctest::Approx(5.0 / 7.0 * tangential).epsilon(2.0e-4));
  CHECK(end.spin[0][1] * radius == doctest::Approx(5.0 / 7.0 * tangential).epsilon(2.0e-4));
}

TEST_CASE_TEMPLATE("sticking at eight steps a contact: no slip is left, none is turned round, and speed is traded for "
                   "spin at the sphere's own rate",
                   Run, OracleRun, SolverRun) {
  const double tangential = 0.005;
  const Scene scene = oblique_floor_hit(tangential, 10.0, 8.0);
  Run run(scene);
  run_all(run, scene);
  const GranuleTable end = run.granules();
  const double speed = end.velocity[0][0], surface = end.spin[0][1] * radius;
  const double slip = speed - surface;
  // Each of the seven to nine steps in contact takes half of it.
  CHECK(slip >= 0.0);
  CHECK(slip <= std::pow(0.5, 6.0) * tangential);
  CHECK(tangential - speed == doctest::Approx(0.4 * surface).epsilon(5.0e-4));
  CHECK(speed == doctest::Approx(5.0 / 7.0 * tangential + 2.0 / 7.0 * slip).epsilon(5.0e-4));
}

TEST_CASE_TEMPLATE("two granules that hit obliquely, sliding: both lose mu (1 + e) of their own normal speed", Run,
                   OracleRun, SolverRun) {
  const double tangential = 0.05, mu = 0.1;
  Scene scene = two_granules(radius, normal_speed, 1.0e-9, {0.0, 1.0, 0.0});
  scene.contact.damping = NormalDamping::none;
  scene.contact.granule.alpha.reset();
  scene.contact.wall->alpha.reset();
  scene.contact.granule.friction = mu;
  Population& pair = scene.populations[0];
  // The tangential flight before touch turns the line of centres by 1e-6; nothing to speak of.
  pair.velocities[0][2] = tangential;
  pair.velocities[1][2] = -tangential;
  use_step(scene, pair_contact_duration(scene, 2.0 * normal_speed) / 1000.0);
  Run run(scene);
  run_all(run, scene);
  const GranuleTable end = run.granules();
  const double lost = mu * 2.0 * normal_speed;
  // The contact itself turns by v_t T_c / r in its course: hence the wider tolerance.
  CHECK(end.velocity[0][2] == doctest::Approx(tangential - lost).epsilon(2.0e-3));
  CHECK(end.velocity[1][2] == doctest::Approx(-end.velocity[0][2]).epsilon(1.0e-12));
  CHECK(end.spin[0][0] * radius == doctest::Approx(2.5 * lost).epsilon(2.0e-2));
  CHECK(end.spin[1][0] == doctest::Approx(end.spin[0][0]).epsilon(1.0e-12)); // as gears do not: both the same way
}

TEST_CASE_TEMPLATE("without rotation slip comes from the centres alone and no spin appears", Run, OracleRun,
                   SolverRun) {
  Scene scene = oblique_floor_hit(0.05, 0.1, 1000.0);
  scene.contact.rotation = false;
  Run sliding(scene);
  run_all(sliding, scene);
  CHECK(sliding.granules().velocity[0][0] == doctest::Approx(0.05 - 0.002).epsilon(1.0e-5));
  CHECK(length(sliding.granules().spin[0]) == 0.0);

  scene = oblique_floor_hit(0.005, 1.0, 1000.0);
  scene.contact.rotation = false;
  Run sticking(scene);
  run_all(sticking, scene);
  CHECK(std::abs(sticking.granules().velocity[0][0]) < 1.0e-6); // it sticks dead: all the tangential speed is gone
}

TEST_CASE_TEMPLATE("kinetic energy never rises in an oblique hit, at any angle and friction", Run, OracleRun,
                   SolverRun) {
  double worst = 0.0;
  for (const double degrees : {0.0, 15.0, 45.0, 70.0, 80.0, 85.0, 89.0})
    for (const double mu : {0.0, 0.1, 0.52, 2.0})
      for (const double spin : {-2000.0, 0.0, 500.0}) {
        const double angle = degrees * 3.14159265358979 / 180.0, speed = 2.0;
        Scene scene = granule_and_floor(radius, 1.0e-7, {speed * std::sin(angle), 0.0, -speed * std::cos(angle)},
                                        {10.0, spin, -20.0});
        scene.contact.wall->friction = mu;
        scene.contact.granule.friction = mu;
        use_step(scene, wall_contact_duration(scene, speed) / 8.0);
        Run run(scene);
        const double before = run.sample().stored.kinetic;
        run_all(run, scene);
        worst = std::max(worst, run.sample().stored.kinetic / before - 1.0);
      }
  CHECK(worst <= 1.0e-12);
}
