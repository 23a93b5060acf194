// T_c, the closing speed that it is taken at, and the step that follows.
#include "solver/errors.hpp"
#include "solver/impact_speed.hpp"
#include "solver/time_step.hpp"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace grandamp;

namespace {

constexpr double pi = std::numbers::pi;

Population acrylic(double radius, std::size_t count) {
  Population population;
  population.name = "acrylic";
  population.count = count;
  population.radius = radius;
  population.mass = 1190.0 * 4.0 / 3.0 * pi * radius * radius * radius;
  return population;
}

/// The paper's stiffnesses, for radii in metres.
Contact paper_contact() {
  Contact contact;
  contact.granule.stiffness = 1.0e7;
  contact.granule.reference_radius = 3.0e-3;
  contact.granule.alpha = 0.077;
  contact.granule.friction = 0.52;
  contact.wall = contact.granule;
  contact.wall->stiffness = 1.3e7;
  return contact;
}

/// Table 5 of the paper, at resonance.
Scene table_5() {
  Scene scene;
  scene.gravity = {0.0, 0.0, -9.81};
  scene.enclosure.size = {0.025, 0.025, 0.0359};
  scene.populations = {acrylic(1.85e-3, 317)};
  scene.contact = paper_contact();
  scene.structure = Structure{};
  scene.structure->mass = 0.1;
  scene.structure->stiffness = 1000.0;
  scene.structure->damping = 0.2;
  scene.excitation.kind = ExcitationKind::harmonic;
  scene.excitation.static_deflection = 0.5e-3;
  scene.excitation.frequency = 15.91;
  scene.time.duration = 7.0;
  return scene;
}

TimeStep step_of(const Scene& scene) {
  return choose_time_step(scene, make_contact_table(scene));
}

/// Duration of an undamped head-on contact by a fine numerical solution: m d'' = -k d^1.5.
double integrated_duration(double mass, double stiffness, double speed) {
  const double dt = 1.0e-10;
  double overlap = 0.0, velocity = speed, time = 0.0;
  while (true) {
    velocity -= dt * stiffness / mass * std::pow(overlap, 1.5);
    const double next = overlap + dt * velocity;
    if (next <= 0.0) return time + dt * overlap / (overlap - next);
    overlap = next;
    time += dt;
  }
}

} // namespace

TEST_CASE("T_c is the duration of an undamped contact of Table 1") {
  const Population granule = acrylic(1.5e-3, 2);
  const double stiffness = 1.0e7 * std::sqrt(0.5), mass = 0.5 * granule.mass;
  const double duration = hertz_contact_duration(mass, stiffness, 5.0);
  CHECK(duration == doctest::Approx(integrated_duration(mass, stiffness, 5.0)).epsilon(2e-4));
  // Damped (alpha = 0.077) it is 4.008e-5 s: a little longer.
  CHECK(duration < 4.008e-5);
  CHECK(duration > 0.98 * 4.008e-5);
  CHECK(contact_duration_at(duration, 5.0, 0.05) ==
        doctest::Approx(hertz_contact_duration(mass, stiffness, 0.05)).epsilon(1e-12));
}

TEST_CASE("the contact table gives that pair its stiffness") {
  Scene scene;
  scene.enclosure.size = {0.02, 0.02, 0.02};
  scene.populations = {acrylic(1.5e-3, 2)};
  scene.populations[0].speed = 2.5;
  scene.contact = paper_contact();
  scene.time.duration = 0.02;
  const TimeStep step = step_of(scene);
  CHECK(step.impact_speed == doctest::Approx(5.0));
  CHECK(step.estimated);
  CHECK(step.contact_duration ==
        doctest::Approx(hertz_contact_duration(0.5 * scene.populations[0].mass, 1.0e7 * std::sqrt(0.5), 5.0))
            .epsilon(1e-12));
  CHECK(step.step <= step.contact_duration / 8.0);
  CHECK(step.step > step.contact_duration / 8.1);
  CHECK(step.step * static_cast<double>(step.steps) == doctest::Approx(0.02).epsilon(1e-15));
}

TEST_CASE("Table 5 at resonance - about 6 microseconds from the bare structure's 2.5 m/s") {
  const TimeStep step = step_of(table_5());
  CHECK(step.impact_speed > 2.0 * 2.47);
  CHECK(step.impact_speed < 5.2);
  CHECK(step.contact_duration == doctest::Approx(4.9e-5).epsilon(0.02));
  CHECK(step.reason.find("acrylic against acrylic") != std::string::npos);
  MESSAGE(step.reason << ": " << step.step);
}

TEST_CASE("closing speed - a common motion is no impact and a box that starts is one") {
  Scene scene;
  scene.enclosure.size = {0.02, 0.02, 0.02};
  scene.populations = {acrylic(1.5e-3, 4)};
  scene.time.duration = 0.1;
  CHECK(estimate_impact_speed(scene).speed == 0.01);
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.velocity = 3.0;
  CHECK(estimate_impact_speed(scene).speed == doctest::Approx(6.0));
  scene.populations[0].velocities.assign(4, {3.0, 0.0, 0.0});
  CHECK(estimate_impact_speed(scene).speed == 0.01);
  scene.populations[0].velocities[2] = {3.0, 4.0, 0.0};
  CHECK(estimate_impact_speed(scene).speed == doctest::Approx(8.0));
  scene.populations[0].velocities.clear();
  scene.excitation.velocity.reset();
  scene.excitation.amplitude = 1.0e-3;
  scene.excitation.frequency = 50.0;
  CHECK(estimate_impact_speed(scene).speed == doctest::Approx(2.0e-3 * 100.0 * pi).epsilon(1e-3));
}

TEST_CASE("closing speed - the bare structure's own velocity in free decay and resonance without damping") {
  Scene scene;
  scene.enclosure.size = {0.02, 0.02, 0.02};
  scene.populations = {acrylic(1.5e-3, 4)};
  scene.structure = Structure{};
  scene.structure->mass = 0.1;
  scene.structure->stiffness = 1000.0;
  scene.structure->displacement = 0.01;
  scene.time.duration = 1.0;
  CHECK(estimate_impact_speed(scene).speed == doctest::Approx(2.0 * 100.0 * 0.01).epsilon(2e-3));
  scene.structure->displacement = 0.0;
  scene.excitation.kind = ExcitationKind::harmonic;
  scene.excitation.force = 0.5;
  scene.excitation.frequency = 100.0 / (2.0 * pi);
  CHECK(estimate_impact_speed(scene).speed ==
        doctest::Approx(2.0 * 0.5 / (2.0 * 0.1) * 1.0).epsilon(0.02)); // F0 t / 2M
  // Far more periods than are looked at one by one: still no less than what comes.
  scene.structure->damping = 1.0e-4;
  scene.time.duration = 1.0e5;
  const double steady = 0.5 / 1.0e-4;
  CHECK(estimate_impact_speed(scene).speed >= 2.0 * steady * 0.99);
  // Overdamped without a limit: nothing overflows.
  scene.structure->damping = 1.0e6;
  const double slow = estimate_impact_speed(scene).speed;
  CHECK(slow >= 0.01);
  CHECK(slow < 1.0);
}

TEST_CASE("the lightest and stiffest pair rules by granule where radii and masses are given one by one") {
  Scene scene;
  scene.enclosure.size = {0.1, 0.1, 0.1};
  scene.populations = {acrylic(1.0e-3, 10), acrylic(10.0e-3, 10)};
  scene.contact = paper_contact();
  scene.contact.wall.reset();
  scene.time.duration = 0.1;
  scene.time.impact_speed = 1.0;
  const double coefficient = 1.0e7 * std::sqrt(2.0 / 3.0e-3);
  double least = 1.0;
  for (const double a : {1.0e-3, 10.0e-3})
    for (const double b : {1.0e-3, 10.0e-3}) {
      const double m = acrylic(a, 1).mass * acrylic(b, 1).mass / (acrylic(a, 1).mass + acrylic(b, 1).mass);
      least = std::min(least, hertz_contact_duration(m, coefficient * std::sqrt(a * b / (a + b)), 1.0));
    }
  const TimeStep both = step_of(scene);
  CHECK(both.contact_duration == doctest::Approx(least).epsilon(1e-12));
  CHECK_FALSE(both.estimated);

  Population listed = acrylic(1.0e-3, 20);
  listed.positions.resize(20);
  for (std::size_t i = 0; i < 20; ++i) {
    listed.radii.push_back(i < 10 ? 1.0e-3 : 10.0e-3);
    listed.masses.push_back(acrylic(listed.radii.back(), 1).mass);
  }
  scene.populations = {listed};
  CHECK(step_of(scene).contact_duration == doctest::Approx(least).epsilon(1e-12));
}

TEST_CASE("an ultralight structure gets a step that bears many contacts at once") {
  Scene scene = table_5();
  scene.time.impact_speed = 1.0;
  const TimeStep heavy = step_of(scene);
  scene.structure->mass = 1.0e-3 * scene.populations[0].mass;
  scene.structure->stiffness = 0.0;
  scene.structure->damping = 0.0;
  scene.excitation = Excitation{};
  const TimeStep light = step_of(scene);
  // N granules of mass m on the mass M swing with the square k (1/m + N/M): at least one contact's share of that.
  const double one = std::pow(1.0e-3, 0.4);
  CHECK(light.contact_duration < heavy.contact_duration * one * 1.5);
  CHECK(light.reason.find("wall") != std::string::npos);
}

TEST_CASE("linear damping bounds the step when it is strong") {
  Scene scene = table_5();
  scene.contact.damping = NormalDamping::linear;
  scene.contact.granule.normal_damping = 0.01;
  scene.contact.wall->normal_damping = 0.01;
  const TimeStep weak = step_of(scene);
  scene.contact.granule.normal_damping = 100.0;
  const TimeStep strong = step_of(scene);
  CHECK(weak.step > 5.0e-6);
  CHECK(strong.step <= 0.25 * 0.5 * scene.populations[0].mass / 100.0);
  CHECK(strong.reason.find("damping") != std::string::npos);
}

TEST_CASE("a given step - rounded to the duration or refused with the largest allowed") {
  Scene scene = table_5();
  scene.time.duration = 1.0e-3;
  scene.time.step = 3.3e-6;
  const TimeStep step = step_of(scene);
  CHECK(step.steps == 303);
  CHECK(step.step == doctest::Approx(1.0e-3 / 303.0).epsilon(1e-15));
  scene.time.step = 1.0e-4;
  try {
    step_of(scene);
    FAIL("a step above T_c/3 was accepted");
  } catch (const SceneError& error) {
    CHECK(error.problems().at(0).key == "time.step");
    CHECK(error.problems().at(0).allowed.find("at most") != std::string::npos);
  }
  scene.time.step.reset();
  scene.time.steps_per_contact = 2.0;
  CHECK_THROWS_AS(step_of(scene), SceneError);
}

TEST_CASE("strong damping shortens verlet's step, whose forces see velocities half a step ahead, and not leapfrog's") {
  Scene scene = table_5();
  const auto restitute = [&scene](double restitution) {
    for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
      constants->alpha.reset();
      constants->restitution = restitution;
    }
  };
  restitute(0.1);
  const TimeStep leapfrog = step_of(scene);
  CHECK(leapfrog.contact_duration / leapfrog.step == doctest::Approx(8.0).epsilon(1.0e-4));
  scene.time.integrator = Integrator::verlet;
  const TimeStep verlet = step_of(scene);
  const double alpha = -std::sqrt(5.0) * std::log(0.1) / std::hypot(std::log(0.1), pi);
  CHECK(verlet.contact_duration / verlet.step == doctest::Approx(14.0 * alpha).epsilon(1.0e-4));
  CHECK(verlet.reason.find("verlet") != std::string::npos);
  restitute(0.9);
  CHECK(step_of(scene).step == doctest::Approx(leapfrog.step).epsilon(1.0e-4));
}

TEST_CASE("without granules the sampling alone sets the step") {
  Scene scene = table_5();
  scene.populations.clear();
  TimeStep step = step_of(scene);
  CHECK(step.contact_duration == 0.0);
  CHECK(step.step <= 2.0 * pi * std::sqrt(0.1 / 1000.0) / 1000.0);
  CHECK(step.step > 6.0e-5);
  scene.output.history_interval = 1.0e-5;
  step = step_of(scene);
  CHECK(step.step == doctest::Approx(1.0e-5).epsilon(1e-12));
  CHECK(step.steps == 700000);
  scene.time.step = 0.01;
  CHECK(step_of(scene).steps == 700);
  scene.time.duration = 1.0e-7;
  scene.time.step.reset();
  CHECK(step_of(scene).steps == 1);
}
