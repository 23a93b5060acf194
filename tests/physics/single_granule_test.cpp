// One granule: flight, rest on the floor, rolling, a box that moves around it.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE_TEMPLATE("a projectile flies its parabola to rounding, with either integrator", Run, OracleRun, SolverRun) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    const Vector3 from{0.01, 0.02, 0.01}, velocity{0.4, -0.1, 0.3}, spin{1.0, -2.0, 3.0};
    Scene scene = box_scene(0.06, 1.5e-3);
    scene.gravity = {0.5, -1.0, -9.81};
    add_granule(scene, from, velocity, spin);
    scene.time.integrator = integrator;
    scene.time.duration = 0.05;
    use_step(scene, 1.0e-5);
    Run run(scene);
    run_all(run, scene);
    const GranuleTable end = run.granules();
    const double t = scene.time.duration;
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(end.position[0][k] ==
            doctest::Approx(from[k] + velocity[k] * t + 0.5 * scene.gravity[k] * t * t).epsilon(1.0e-11));
      CHECK(end.velocity[0][k] == doctest::Approx(velocity[k] + scene.gravity[k] * t).epsilon(1.0e-11));
      CHECK(end.spin[0][k] == doctest::Approx(spin[k]).epsilon(1.0e-14));
    }
  }
}

TEST_CASE_TEMPLATE("in a shaken box a free granule still flies straight in the laboratory", Run, OracleRun, SolverRun) {
  Scene scene = box_scene(0.06, 1.5e-3);
  const Vector3 from{0.03, 0.03, 0.03}, velocity{0.1, -0.2, 0.05};
  add_granule(scene, from, velocity);
  scene.time.duration = 0.05;
  use_step(scene, 1.0e-5);
  const double t = scene.time.duration;
  const auto check = [&](const Vector3& direction, double tolerance) {
    Run run(scene);
    run_all(run, scene);
    const GranuleTable end = run.granules();
    const double displacement = run.sample().displacement;
    CHECK(std::abs(displacement) > 1.0e-6);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(std::abs(end.position[0][k] + displacement * direction[k] - from[k] - velocity[k] * t) < tolerance);
      CHECK(std::abs(end.velocity[0][k] - velocity[k]) < 1.0e-6);
    }
  };
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.direction = {0.6, 0.8, 0.0};
  scene.excitation.amplitude = 2.0e-3;
  scene.excitation.frequency = 47.0;
  check(scene.excitation.direction, 1.0e-12);
  scene.excitation = Excitation{};
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.velocity = -0.2;
  check({1.0, 0.0, 0.0}, 1.0e-12);
  scene.excitation = Excitation{};
  scene.structure = bare_structure().structure;
  scene.structure->velocity = 0.3;
  check({0.0, 0.0, 1.0}, 1.0e-8); // the drift is a sum over steps, the structure exact: they part as dt^2
}

TEST_CASE_TEMPLATE("a granule at rest on the floor sinks by (m g / k)^(2/3) and stays", Run, OracleRun, SolverRun) {
  const double radius = 1.5e-3, g = 9.81;
  Scene scene = granule_and_floor(radius, 0.0, {});
  scene.gravity = {0.0, 0.0, -g};
  scene.contact.wall->alpha.reset();
  scene.contact.wall->restitution = 0.5;
  scene.time.impact_speed = 0.1;
  scene.time.duration = 0.012;
  use_step(scene, 1.0e-6);
  Run run(scene);
  const double weight = scene.populations[0].mass * g;
  const double stiffness = 1.3e7 * std::sqrt(radius / 3.0e-3);
  const double sunk = std::pow(weight / stiffness, 2.0 / 3.0);
  const double scale = std::sqrt(g * sunk);
  double late = 0.0, later = 0.0;
  const std::int64_t steps = steps_of(scene);
  for (std::int64_t n = 0; n < steps; ++n) {
    if (n > steps / 4 && n < steps / 2 && n % 10 == 0) late = std::max(late, length(run.granules().velocity[0]));
    if (n > 3 * steps / 4 && n % 10 == 0) later = std::max(later, length(run.granules().velocity[0]));
    run.step();
  }
  CHECK(radius - run.granules().position[0][2] == doctest::Approx(sunk).epsilon(1.0e-6));
  CHECK(late < 1.0e-2 * scale);
  CHECK(later < 1.0e-6 * scale);
  CHECK(run.granules().position[0][0] == 20.0 * radius);
  CHECK(length(run.granules().spin[0]) == 0.0);
}

TEST_CASE_TEMPLATE("a granule pushed along the floor slides for 2 v / (7 mu g), then rolls at 5/7 of its speed", Run,
                   OracleRun, SolverRun) {
  const double radius = 1.5e-3, g = 9.81, mu = 0.3, speed = 0.02;
  const double stiffness = 1.3e7 * std::sqrt(radius / 3.0e-3);
  const double sunk = std::pow(sphere_mass(radius) * g / stiffness, 2.0 / 3.0);
  Scene scene = granule_and_floor(radius, -sunk, {speed, 0.0, 0.0});
  scene.gravity = {0.0, 0.0, -g};
  scene.contact.wall->friction = mu;
  scene.time.impact_speed = 0.1;
  scene.time.duration = 4.0e-3;
  use_step(scene, 1.0e-6);
  Run run(scene);
  const double sliding_time = 2.0 * speed / (7.0 * mu * g);
  const auto half = static_cast<std::int64_t>(0.5 * sliding_time / run.time_step());
  for (std::int64_t n = 0; n < half; ++n) run.step();
  CHECK(run.granules().velocity[0][0] ==
        doctest::Approx(speed - mu * g * static_cast<double>(half) * run.time_step()).epsilon(1.0e-5));
  for (std::int64_t n = half; n < steps_of(scene); ++n) run.step();
  CHECK(run.granules().velocity[0][0] == doctest::Approx(5.0 / 7.0 * speed).epsilon(1.0e-4));
  CHECK(run.granules().spin[0][1] * radius == doctest::Approx(5.0 / 7.0 * speed).epsilon(1.0e-4));
}
