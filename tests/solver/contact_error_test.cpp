// The error of single contacts, and the steps that are chosen by it: against the solver itself, on contacts that the
// calibration has not seen.
#include "solver/plan.hpp"
#include "solver/random_numbers.hpp"
#include "solver/run_state.hpp"
#include "solver/time_step.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// What the granules have after an impact: velocities (m/s), and radius times spin.
struct Left {
  std::vector<Vector3> velocity, turn;
};

Left left_after(const Scene& scene) {
  SolverRun run(scene);
  while (!run.simulation().finished()) run.step();
  const GranuleTable end = run.granules();
  Left left{end.velocity, end.spin};
  for (std::size_t i = 0; i < left.turn.size(); ++i)
    for (double& component : left.turn[i]) component *= end.radius[i];
  return left;
}

double energy(const std::vector<Vector3>& velocity, const std::vector<Vector3>& turn, const std::vector<double>& mass) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i)
    sum += mass[i] * (dot(velocity[i], velocity[i]) + 0.4 * dot(turn[i], turn[i]));
  return sum;
}

/// Squared: the kinetic energy of what the granules' motion is off by, over that of their motion before.
double squared_error(const Left& met, const Left& right, const Scene& before) {
  const Population& p = before.populations[0];
  Left off = met, start;
  for (std::size_t i = 0; i < off.velocity.size(); ++i) {
    off.velocity[i] = difference(met.velocity[i], right.velocity[i]);
    off.turn[i] = difference(met.turn[i], right.turn[i]);
    Vector3 turn = p.spins[i];
    for (double& component : turn) component *= p.radii[i];
    start.turn.push_back(turn);
  }
  start.velocity = p.velocities;
  return energy(off.velocity, off.turn, p.masses) / energy(start.velocity, start.turn, p.masses);
}

/// Two granules of unlike radius that meet at some speed, offset, direction, spin and phase of a step.
Scene random_impact(RandomNumbers& random, double speed_most, bool friction) {
  Scene scene = box_scene(0.2, 1.5e-3);
  if (!friction) {
    scene.contact.friction = FrictionLaw::none;
    scene.contact.granule.friction.reset();
    scene.contact.wall->friction.reset();
  }
  Population& p = scene.populations[0];
  p.radii = {1.5e-3, random.uniform(1.5e-3, 2.5e-3)};
  p.masses = {sphere_mass(p.radii[0]), sphere_mass(p.radii[1])};
  const double speed = random.uniform(0.1, 1.0) * speed_most;
  const Vector3 line = random.direction();
  Vector3 across = random.direction();
  const double along = dot(across, line);
  for (std::size_t k = 0; k < 3; ++k) across[k] -= along * line[k];
  const double size = length(across), offset = std::sqrt(random.uniform(0.0, 0.8));
  Vector3 relative{};
  for (std::size_t k = 0; k < 3; ++k)
    relative[k] = speed * (std::sqrt(1.0 - offset * offset) * line[k] + offset * across[k] / size);
  const double share = p.masses[1] / (p.masses[0] + p.masses[1]);
  // 2.6 contact durations to come, of which a part before the touch.
  const double reach = p.radii[0] + p.radii[1], before = random.uniform(0.3e-5, 1.0e-5);
  Vector3 first{}, second{}, first_velocity{}, second_velocity{};
  for (std::size_t k = 0; k < 3; ++k) {
    first_velocity[k] = share * relative[k];
    second_velocity[k] = (share - 1.0) * relative[k];
    first[k] = 0.1 - first_velocity[k] * before;
    second[k] = 0.1 + reach * line[k] - second_velocity[k] * before;
  }
  Vector3 spin = random.direction(), other = random.direction();
  for (std::size_t k = 0; k < 3; ++k) {
    spin[k] *= friction ? 0.5 * speed / p.radii[0] : 0.0;
    other[k] *= friction ? 0.5 * speed / p.radii[1] : 0.0;
  }
  add_granule(scene, first, first_velocity, spin);
  add_granule(scene, second, second_velocity, other);
  scene.time.impact_speed = speed_most;
  scene.time.duration = 2.0e-4;
  return scene;
}

/// Root mean square of the errors of impacts that nobody calibrated, with the steps that `asked` leads to. The law is
/// scale-free, so that these are the same for all of them.
double error_met(double asked, bool friction, std::size_t impacts, double& steps_per_contact) {
  RandomNumbers random(20, 7);
  Scene asking = random_impact(random, 5.0, friction);
  asking.time.error = asked;
  steps_per_contact = make_plan(asking).step_choice.value().steps_per_contact;
  double sum = 0.0;
  for (std::size_t n = 0; n < impacts; ++n) {
    Scene scene = random_impact(random, 5.0, friction);
    Scene fine = scene;
    scene.time.steps_per_contact = steps_per_contact;
    fine.time.steps_per_contact = 2000.0;
    sum += squared_error(left_after(scene), left_after(fine), scene);
  }
  return std::sqrt(sum / static_cast<double>(impacts));
}

Scene damper_of_restitution(double restitution) {
  Scene scene = table_5(10, 0.1);
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    constants->alpha.reset();
    constants->restitution = restitution;
  }
  return scene;
}

} // namespace

TEST_CASE("the error of a contact without friction is that of the restitution, at the published scatter") {
  Scene scene = two_granules(1.5e-3, 2.5, 1.0e-6);
  make_lossless(scene);
  scene.contact.damping = NormalDamping::tsuji;
  scene.contact.granule.alpha = scene.contact.wall->alpha = 0.077;
  const ContactCalibration calibration = calibrate_contacts(scene, make_contact_table(scene), 5.0);
  const double contact = pair_contact_duration(scene, 5.0);
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    const RestitutionMet met = calibration.restitution_at(contact / 8.0, integrator);
    CHECK(met.exact == doctest::Approx(0.8974).epsilon(1e-4));
    CHECK(std::abs(met.mean - (integrator == Integrator::leapfrog ? 0.8976 : 0.890)) < 1.0e-3);
    // The calibration's own error is of the kind that lasts shortest at its speed, and of no other quantity.
    CHECK(calibration.error_at(contact / 8.0, integrator).error >=
          0.999 * std::hypot(met.mean - met.exact, met.deviation));
  }
  CHECK(calibration.restitution_at(contact / 8.0, Integrator::leapfrog).deviation ==
        doctest::Approx(0.0058).epsilon(0.25));
}

TEST_CASE("error = 0.01 and 0.001 are met by contacts that the calibration has not seen") {
  const std::size_t impacts = full_tests() ? 400 : 60;
  for (const bool friction : {true, false})
    for (const double asked : {0.05, 0.01, 0.001}) {
      CAPTURE(friction);
      CAPTURE(asked);
      double steps = 0.0;
      const double met = error_met(asked, friction, impacts, steps);
      CAPTURE(steps);
      CHECK(met <= asked);
      CHECK(met > 0.02 * asked); // otherwise it would be dearer than what was asked for
    }
}

TEST_CASE("smaller errors take more steps, and the choice says which contact makes it so") {
  Scene scene = table_5(10, 0.1);
  double before = 0.0;
  for (const double asked : {0.02, 0.01, 0.005, 0.001}) {
    scene.time.error = asked;
    const Plan plan = make_plan(scene);
    REQUIRE(plan.step_choice.has_value());
    CHECK(plan.step_choice->error <= asked);
    CHECK(plan.step_choice->coarser_error > asked);
    CHECK(plan.step_choice->steps_per_contact > before);
    CHECK(plan.time_step <= plan.contact_duration / plan.step_choice->steps_per_contact);
    CHECK(plan.time_step_reason.find("against") != std::string::npos);
    before = plan.step_choice->steps_per_contact;
  }
}

TEST_CASE("an error is met by the integrator that the scene names, or the one that needs fewer steps") {
  Scene scene = damper_of_restitution(0.1);
  scene.contact.friction = FrictionLaw::none;
  scene.contact.granule.friction.reset();
  scene.contact.wall->friction.reset();
  scene.time.error = 0.01;
  const Plan leapfrog = make_plan(scene);
  CHECK(leapfrog.scene.time.integrator == Integrator::leapfrog);
  scene.time.integrator_free = true;
  const Plan chosen = make_plan(scene);
  CHECK(chosen.scene.time.integrator == Integrator::verlet); // heavy damping wants velocities of the right instant
  CHECK(chosen.step_choice->steps_per_contact < leapfrog.step_choice->steps_per_contact);

  Scene springy = damper_of_restitution(0.97);
  springy.time.error = 0.01;
  springy.time.integrator_free = true;
  CHECK(make_plan(springy).scene.time.integrator == Integrator::leapfrog);
}

TEST_CASE("errors that no step reaches and errors beside a step are refused") {
  Scene scene = table_5(10, 0.1);
  const auto faulty = [&](const std::string& part) {
    try {
      make_plan(scene);
    } catch (const SceneError& error) {
      REQUIRE(error.problems().size() == 1);
      CHECK(error.problems()[0].key == "time.error");
      CHECK((error.problems()[0].message + error.problems()[0].allowed).find(part) != std::string::npos);
      return;
    }
    FAIL("not refused");
  };
  scene.time.error = 1.0e-9;
  faulty("not reached with 256 steps");
  scene.time.error = -0.01;
  faulty("above 0");
  scene.time.error = std::nan("");
  faulty("above 0");
  scene.time.error = 0.01;
  scene.time.step = 1.0e-6;
  faulty("one of them");
}

TEST_CASE("a run whose step was chosen by an error goes on by the same bits") {
  Scene scene = table_5(12, 0.004);
  scene.time.error = 0.01;
  scene.time.integrator_free = true;
  Simulation whole(scene), first(scene);
  for (int n = 0; n < 300; ++n) {
    whole.step();
    first.step();
  }
  Simulation second(scene, first.state());
  CHECK(second.plan().time_step == whole.plan().time_step);
  for (int n = 0; n < 300; ++n) {
    whole.step();
    second.step();
  }
  const GranuleTable a = whole.granules(), b = second.granules();
  CHECK(a.position == b.position);
  CHECK(a.velocity == b.velocity);
}

TEST_CASE("a bare structure has no contact whose error could be asked for") {
  Scene scene = bare_structure();
  scene.time.duration = 1.0;
  const Plan without = make_plan(scene);
  scene.time.error = 0.01;
  const Plan with = make_plan(scene);
  CHECK_FALSE(with.step_choice.has_value());
  CHECK(with.time_step == without.time_step);
}
