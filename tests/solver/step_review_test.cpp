// `step = "adaptive"`: contacts faster than expected are followed, nothing else moves otherwise, and runs go on by the
// same bits wherever they are cut.
#include "solver/run_state.hpp"
#include "solver/simulation.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <numbers>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// A damper whose step rests on a closing speed of 1 cm/s, far below what it meets.
Scene too_slow_a_guess(std::size_t granules, double duration) {
  Scene scene = table_5(granules, duration);
  scene.structure->displacement = 4.0e-3; // struck at once
  scene.time.step.reset();
  scene.time.impact_speed = 0.01;
  scene.time.adaptive = true;
  return scene;
}

RunOptions threads(int count) {
  RunOptions options;
  options.threads = count;
  return options;
}

} // namespace

TEST_CASE("adaptive: a contact two hundred times faster than expected keeps its restitution") {
  Scene scene = two_granules(1.5e-3, 2.5, 1.0e-4);
  scene.time.step.reset();
  scene.time.steps_per_contact = 8.0;
  scene.time.impact_speed = 0.02;
  scene.time.duration = 4.0e-4;
  {
    Simulation fixed(scene);
    CHECK_THROWS_AS(
        [&] {
          while (!fixed.finished()) fixed.step();
        }(),
        GuardError);
  }
  scene.time.adaptive = true;
  Simulation run(scene);
  while (!run.finished()) run.step();
  const GranuleTable end = run.granules();
  CHECK(std::abs((end.velocity[1][0] - end.velocity[0][0]) / 5.0 - 0.8974) < 0.01);
  CHECK(std::abs(end.velocity[1][0] + end.velocity[0][0]) < 1.0e-13);
  CHECK(run.step_review().parts == 3);
  CHECK(run.step_review().refined > 0);
}

TEST_CASE(
    "adaptive: a granule that meets nothing flies straight, and the structure moves as if whole steps were taken") {
  for (const double guess : {0.1, 1.0e-4, 1.0e-7}) { // 3, 9 and 27 parts
    CAPTURE(guess);
    Scene scene = table_5(1, 0.02);
    scene.gravity = {};
    scene.populations[0].positions = {{4.0e-3, 5.0e-3, 8.0e-3}};
    scene.populations[0].velocities = {{0.4, 0.3, 0.5}};
    scene.structure->velocity = 0.2;
    scene.time.step.reset();
    scene.time.impact_speed = guess;
    const auto flown = [&](bool adaptive, double* displacement, double* work) {
      scene.time.adaptive = adaptive;
      Simulation run(scene);
      for (std::int64_t n = run.plan().steps / 2; n > 0; --n) run.step();
      const Sample now = run.sample();
      *displacement = now.displacement;
      *work = now.ledger.work_in;
      CHECK(run.step_review().parts == (!adaptive ? 1 : guess > 0.01 ? 3 : guess > 1.0e-5 ? 9 : 27));
      // The structure's own solution is exact, the granule sees it by steps: its second derivative is at most 20 m/s^2.
      const double allowed = 20.0 * run.plan().time_step * run.plan().time_step;
      Vector3 place = run.granules().position[0];
      place[2] += now.displacement;
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(std::abs(place[k] - scene.populations[0].positions[0][k] -
                       scene.populations[0].velocities[0][k] * run.time()) < allowed);
    };
    double plain = 0.0, in_parts = 0.0, plain_work = 0.0, work_in_parts = 0.0;
    flown(false, &plain, &plain_work);
    flown(true, &in_parts, &work_in_parts);
    CHECK(in_parts == doctest::Approx(plain).epsilon(1.0e-11));
    CHECK(work_in_parts == doctest::Approx(plain_work).epsilon(1.0e-10));
  }
}

TEST_CASE("adaptive: a damper on too slow a guess closes its balance of energy") {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Scene scene = too_slow_a_guess(80, 0.1);
    scene.time.integrator = integrator;
    Simulation run(scene, threads(1));
    const Sample start = run.sample();
    while (!run.finished()) run.step();
    CHECK(run.step_review().refined > run.plan().steps / 2);
    CHECK(std::abs(ledger_residual(start, run.sample())) < 0.01);
  }
}

TEST_CASE("adaptive: cut anywhere, sampled or not, on any number of threads, the bits are the same") {
  for (const bool springs : {false, true}) {
    Scene scene = too_slow_a_guess(60, 0.02);
    if (springs) {
      scene.contact.friction = FrictionLaw::spring;
      scene.contact.granule.tangential_stiffness = 8.0e6;
      if (scene.contact.wall) scene.contact.wall->tangential_stiffness = 8.0e6;
    }
    Simulation whole(scene, threads(1));
    while (!whole.finished()) whole.step();
    const GranuleTable expected = whole.granules();
    CHECK(whole.step_review().refined > 100);
    CHECK(whole.step_review().refined < whole.plan().steps);

    Simulation watched(scene, threads(2));
    auto cut = std::make_unique<Simulation>(scene, threads(1));
    for (std::int64_t n = 0; !watched.finished(); ++n) {
      watched.step_and_sample();
      if (n % 5 == 0) watched.sample();
      cut->step();
      if (n % 97 == 0) cut = std::make_unique<Simulation>(scene, cut->state(), threads(1 + static_cast<int>(n % 2)));
    }
    for (Simulation* other : {&watched, cut.get()}) {
      const GranuleTable found = other->granules();
      CHECK(found.position == expected.position);
      CHECK(found.velocity == expected.velocity);
      CHECK(found.spin == expected.spin);
      CHECK(other->step_review().refined == whole.step_review().refined);
    }
  }
}

TEST_CASE("adaptive: a sample just when a list is due does not change what follows") {
  Scene scene = too_slow_a_guess(300, 0.01);
  scene.verlet.skin = 0.001; // due almost every step
  Simulation alone(scene, threads(1)), watched(scene, threads(1));
  while (!alone.finished()) {
    alone.step();
    watched.sample();
    watched.step();
  }
  CHECK(alone.step_review().refined > 100);
  CHECK(alone.verlet().mean_interval < 3.0);
  CHECK(alone.verlet().builds == watched.verlet().builds);
  CHECK(alone.granules().position == watched.granules().position);
  CHECK(alone.granules().velocity == watched.granules().velocity);
}

TEST_CASE("adaptive: where nothing is faster than expected, not a bit differs") {
  Scene scene = table_5(60, 0.01);
  scene.time.step.reset();
  scene.time.impact_speed = 5.0;
  Simulation plain(scene);
  scene.time.adaptive = true;
  Simulation adaptive(scene);
  while (!plain.finished()) {
    plain.step();
    adaptive.step();
  }
  CHECK(adaptive.step_review().refined == 0);
  CHECK(adaptive.granules().position == plain.granules().position);
  CHECK(adaptive.granules().velocity == plain.granules().velocity);
}

TEST_CASE("adaptive: no contact is missed in parts") {
  Scene scene = too_slow_a_guess(80, 0.02);
  scene.verlet.audit = 1;
  Simulation run(scene, threads(1));
  while (!run.finished()) run.step();
  CHECK(run.verlet().audited > 500);
  CHECK(run.verlet().missed == 0);
}
