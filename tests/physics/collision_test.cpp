// One head-on contact: Fig. 6 of the paper, restitution, contact duration, rigid wall, phases of entry.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// Relative speed after over before of the scene's two granules.
template <class Run> double restitution_of(const Scene& scene, double closing) {
  Run run(scene);
  run_all(run, scene);
  const GranuleTable end = run.granules();
  return length(difference(end.velocity[1], end.velocity[0])) / closing;
}

template <class Run> double mean_restitution(Integrator integrator, double steps_per_contact, int phases) {
  double sum = 0.0;
  for (int p = 0; p < phases; ++p) {
    Scene scene = two_granules(1.5e-3, 2.5, 0.0);
    const double step = pair_contact_duration(scene, 5.0) / steps_per_contact;
    scene = two_granules(1.5e-3, 2.5, 5.0 * step * (1.0 + (p + 0.5) / phases));
    scene.time.integrator = integrator;
    use_step(scene, step);
    sum += restitution_of<Run>(scene, 5.0);
  }
  return sum / phases;
}

} // namespace

TEST_CASE_TEMPLATE("Fig. 6: rebound and duration of a head-on contact, converged", Run, OracleRun, SolverRun) {
  Scene scene = two_granules(1.5e-3, 2.5, 1.0e-9);
  use_step(scene, pair_contact_duration(scene, 5.0) / 5000.0);
  Run run(scene);
  std::int64_t touching = 0;
  for (std::int64_t n = steps_of(scene); n > 0; --n) touching += run.step_and_sample().contacts;
  const GranuleTable end = run.granules();
  CHECK(end.velocity[1][0] == doctest::Approx(2.2435).epsilon(1.0e-3));
  CHECK(end.velocity[0][0] == doctest::Approx(-2.2435).epsilon(1.0e-3));
  CHECK(static_cast<double>(touching) * run.time_step() == doctest::Approx(4.008e-5).epsilon(1.0e-3));
}

TEST_CASE_TEMPLATE("restitution is what was asked for, at any speed and radius", Run, OracleRun, SolverRun) {
  const auto hit = [](double e, double radius, double speed) {
    Scene scene = two_granules(radius, speed, 1.0e-9, {2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0});
    scene.contact.granule.alpha.reset();
    scene.contact.granule.restitution = e;
    scene.time.duration *= 2.0; // heavy damping draws the contact out
    use_step(scene, pair_contact_duration(scene, 2.0 * speed) / 2000.0);
    return restitution_of<Run>(scene, 2.0 * speed);
  };
  for (const double e : {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.89, 1.0}) {
    CAPTURE(e);
    CHECK(std::abs(hit(e, 1.5e-3, 2.5) - e) < 1.0e-3);
  }
  CHECK(std::abs(hit(0.6, 0.4e-3, 0.02) - 0.6) < 1.0e-3);
  CHECK(std::abs(hit(0.6, 8.0e-3, 10.0) - 0.6) < 1.0e-3);
}

TEST_CASE_TEMPLATE("restitution holds for granules of unlike radius and mass", Run, OracleRun, SolverRun) {
  Scene scene = two_granules(1.5e-3, 2.5, 1.0e-9);
  Population& population = scene.populations[0];
  population.radii = {1.5e-3, 4.5e-3};
  population.masses = {sphere_mass(1.5e-3), sphere_mass(4.5e-3, 7800.0)};
  population.positions[1][0] += 3.0e-3;
  scene.time.duration *= 2.0;
  use_step(scene, pair_contact_duration(scene, 5.0) / 2000.0);
  CHECK(std::abs(restitution_of<Run>(scene, 5.0) - 0.8974) < 1.0e-3);
}

TEST_CASE_TEMPLATE("an undamped contact lasts 3.2180 (m^2 / k_n^2 v)^(1/5), pair and rigid wall", Run, OracleRun,
                   SolverRun) {
  for (const bool wall : {false, true}) {
    CAPTURE(wall);
    Scene scene = wall ? granule_and_floor(1.5e-3, 1.0e-9, {0.0, 0.0, -2.5}) : two_granules(1.5e-3, 2.5, 1.0e-9);
    scene.contact.damping = NormalDamping::none;
    scene.contact.granule.alpha.reset();
    scene.contact.wall->alpha.reset();
    const double expected = wall ? wall_contact_duration(scene, 2.5) : pair_contact_duration(scene, 5.0);
    use_step(scene, expected / 5000.0);
    Run run(scene);
    std::int64_t touching = 0;
    for (std::int64_t n = steps_of(scene); n > 0; --n) touching += run.step_and_sample().contacts;
    CHECK(static_cast<double>(touching) * run.time_step() == doctest::Approx(expected).epsilon(1.0e-3));
    CHECK(length(run.granules().velocity[0]) == doctest::Approx(2.5).epsilon(1.0e-4));
  }
}

TEST_CASE_TEMPLATE("a rigid wall gives back e v_n, on every face of a box and all around a cylinder", Run, OracleRun,
                   SolverRun) {
  const double radius = 1.5e-3, speed = 1.7, gap = 1.0e-6;
  const auto bounce = [&](Scene scene, const Vector3& normal) {
    const double middle = 20.0 * radius; // of the box, and of the cylinder's bounding box
    Vector3 place{}, velocity{};
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] = middle + normal[k] * (middle - radius - gap);
      velocity[k] = speed * normal[k];
    }
    add_granule(scene, place, velocity);
    scene.contact.wall->alpha.reset();
    scene.contact.wall->restitution = 0.6;
    scene.time.duration = 2.0 * wall_contact_duration(scene, speed);
    use_step(scene, wall_contact_duration(scene, speed) / 2000.0);
    Run run(scene);
    run_all(run, scene);
    const Vector3 after = run.granules().velocity[0];
    CHECK(dot(after, normal) == doctest::Approx(-0.6 * speed).epsilon(1.0e-3));
    CHECK(length(cross(after, normal)) < 1.0e-9);
  };
  const Scene box = box_scene(40.0 * radius, radius);
  for (std::size_t k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      Vector3 normal{};
      normal[k] = sign;
      bounce(box, normal);
    }
  for (int axis = 0; axis < 3; ++axis) {
    Scene cylinder = box;
    cylinder.enclosure = {EnclosureShape::cylinder, {0.0, 0.0, 0.0}, 40.0 * radius, 40.0 * radius, axis};
    const auto along = static_cast<std::size_t>(axis), one = (along + 1) % 3, other = (along + 2) % 3;
    for (const double angle : {0.0, 0.7, 2.0, 3.9}) {
      Vector3 normal{};
      normal[one] = std::cos(angle);
      normal[other] = std::sin(angle);
      bounce(cylinder, normal);
    }
    for (const double sign : {-1.0, 1.0}) {
      Vector3 normal{};
      normal[along] = sign;
      bounce(cylinder, normal);
    }
  }
}

TEST_CASE_TEMPLATE("the mean restitution over 200 phases of entry at T_c/8 is the published one of each integrator",
                   Run, OracleRun, SolverRun) {
  CHECK(std::abs(mean_restitution<Run>(Integrator::leapfrog, 8.0, 200) - 0.8976) < 1.0e-3);
  CHECK(std::abs(mean_restitution<Run>(Integrator::verlet, 8.0, 200) - 0.890) < 1.0e-3);
  if (!full_tests()) return;
  CHECK(std::abs(mean_restitution<Run>(Integrator::leapfrog, 4.0, 200) - 0.900) < 1.5e-3);
  CHECK(std::abs(mean_restitution<Run>(Integrator::leapfrog, 16.0, 200) - 0.8973) < 5.0e-4);
  CHECK(std::abs(mean_restitution<Run>(Integrator::verlet, 4.0, 200) - 0.873) < 1.5e-3);
  CHECK(std::abs(mean_restitution<Run>(Integrator::verlet, 16.0, 200) - 0.8955) < 5.0e-4);
}
