// What must not matter: the frame, left or right, the order in which granules are listed, the day of the run.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// A dense little gas with spins, in a box, with gravity: pair and wall contacts by the hundred within a millisecond.
Scene busy_box() {
  Scene scene = gas(80, 0.018, 2.0, 21);
  scene.gravity = {1.0, -2.0, -9.81};
  for (std::size_t i = 0; i < 80; ++i) {
    const auto turn = static_cast<double>(i);
    scene.populations[0].spins[i] = {200.0 - 5.0 * turn, 3.0 * turn, -100.0};
  }
  scene.time.duration = 1.5e-3;
  use_step(scene, shortest_contact_duration(scene, 2.0) / 8.0);
  return scene;
}

template <class Run> GranuleTable end_of(const Scene& scene) {
  Run run(scene);
  run_all(run, scene);
  return run.granules();
}

double position_error(const GranuleTable& a, const GranuleTable& b) {
  double error = 0.0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    error = std::max(error, length(difference(a.position[i], b.position[i])) / a.radius[i]);
  return error;
}

double velocity_error(const GranuleTable& a, const GranuleTable& b) {
  double error = 0.0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    error = std::max({error, length(difference(a.velocity[i], b.velocity[i])),
                      a.radius[i] * length(difference(a.spin[i], b.spin[i]))});
  return error;
}

} // namespace

TEST_CASE_TEMPLATE("Galilean: a cluster, or a whole box, that moves at a common velocity does the same", Run, OracleRun,
                   SolverRun) {
  const Vector3 common{0.0, 1.7, 0.0};
  // In free space.
  Scene still = imploding_cluster(60, 9);
  still.time.duration = 4.0e-3;
  use_step(still, 4.0e-6);
  Scene moving = still;
  for (Vector3& velocity : moving.populations[0].velocities) velocity[1] += common[1];
  GranuleTable a = end_of<Run>(still), b = end_of<Run>(moving);
  for (Vector3& position : b.position) position[1] -= common[1] * still.time.duration;
  for (Vector3& velocity : b.velocity) velocity[1] -= common[1];
  CHECK(position_error(a, b) < 1.0e-8);
  CHECK(velocity_error(a, b) < 1.0e-8);

  // With the enclosure.
  still = busy_box();
  moving = still;
  for (Vector3& velocity : moving.populations[0].velocities) velocity[1] += common[1];
  moving.excitation.kind = ExcitationKind::prescribed;
  moving.excitation.velocity = common[1];
  moving.excitation.direction = {0.0, 1.0, 0.0};
  a = end_of<Run>(still);
  b = end_of<Run>(moving);
  for (Vector3& velocity : b.velocity) velocity[1] -= common[1];
  CHECK(position_error(a, b) < 1.0e-8);
  CHECK(velocity_error(a, b) < 1.0e-8);
}

TEST_CASE_TEMPLATE("a mirrored scene gives the mirrored motion", Run, OracleRun, SolverRun) {
  const Scene scene = busy_box();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const auto mirror = [&](std::vector<Vector3>& positions, std::vector<Vector3>& velocities,
                            std::vector<Vector3>& spins) {
      for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i][axis] = scene.enclosure.size[axis] - positions[i][axis];
        velocities[i][axis] = -velocities[i][axis];
        for (std::size_t k = 0; k < 3; ++k)
          if (k != axis) spins[i][k] = -spins[i][k]; // an axial vector
      }
    };
    Scene mirrored = scene;
    mirrored.gravity[axis] = -mirrored.gravity[axis];
    Population& population = mirrored.populations[0];
    mirror(population.positions, population.velocities, population.spins);
    const GranuleTable a = end_of<Run>(scene);
    GranuleTable b = end_of<Run>(mirrored);
    mirror(b.position, b.velocity, b.spin);
    CHECK(position_error(a, b) < 1.0e-8);
    CHECK(velocity_error(a, b) < 1.0e-8);
  }
}

TEST_CASE_TEMPLATE("the order in which granules are listed changes nothing beyond rounding", Run, OracleRun,
                   SolverRun) {
  const Scene scene = busy_box();
  Scene shuffled = scene;
  Population& population = shuffled.populations[0];
  const std::size_t count = population.positions.size();
  const auto from = [&](std::size_t i) { return (i * 37 + 11) % count; }; // 37 and 80 share no factor
  for (std::size_t i = 0; i < count; ++i) {
    population.positions[i] = scene.populations[0].positions[from(i)];
    population.velocities[i] = scene.populations[0].velocities[from(i)];
    population.spins[i] = scene.populations[0].spins[from(i)];
  }
  const GranuleTable a = end_of<Run>(scene), listed = end_of<Run>(shuffled);
  GranuleTable b = listed;
  for (std::size_t i = 0; i < count; ++i) {
    b.position[from(i)] = listed.position[i];
    b.velocity[from(i)] = listed.velocity[i];
    b.spin[from(i)] = listed.spin[i];
  }
  CHECK(position_error(a, b) < 1.0e-8);
  CHECK(velocity_error(a, b) < 1.0e-8);
}

TEST_CASE("the same scene gives the same bits twice, and sampling does not touch them") {
  Scene scene = busy_box();
  scene.structure = bare_structure().structure;
  scene.excitation = bare_structure().excitation;
  scene.time.duration = 4.0e-3;
  use_step(scene, *scene.time.step);
  const auto same_bits = [](const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vector3)) == 0;
  };
  SolverRun once(scene), twice(scene), sampled(scene);
  run_all(once, scene);
  run_all(twice, scene);
  for (std::int64_t n = 0; n < steps_of(scene); ++n) {
    if (n % 3 == 0)
      sampled.step_and_sample();
    else
      sampled.step();
    if (n % 7 == 0) sampled.sample();
    if (n % 11 == 0) sampled.granules();
  }
  const GranuleTable a = once.granules();
  for (SolverRun* other : {&twice, &sampled}) {
    const GranuleTable b = other->granules();
    CHECK(same_bits(a.position, b.position));
    CHECK(same_bits(a.velocity, b.velocity));
    CHECK(same_bits(a.spin, b.spin));
    CHECK(once.sample().displacement == other->sample().displacement);
  }
}
