// Structures that make the coupling stiff; enclosures with next to nothing in them.
#include "tests/hard_cases/scenes.hpp"
#include "tests/hard_cases/watch.hpp"
#include "tests/support/closed_form.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// `lone`: all that happens is a few hits, one at a time.
void run_case(const char* name, Scene (*make)(std::uint64_t, bool), bool lone = false) {
  CaseReport report(name);
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    Bounds bounds;
    if (lone) bounds.residual = residual_of_a_contact(choice);
    report.add(choice, watch(make(choice.seed, full_tests()), choice), bounds);
  }
}

/// Largest error of the bare structure's displacement over its largest displacement.
template <class Displacement> double bare_error(const Scene& scene, const Displacement& displacement) {
  SolverRun run(scene);
  Simulation& simulation = run.simulation();
  double error = 0.0, largest = 0.0;
  while (!simulation.finished()) {
    const Sample now = simulation.step_and_sample();
    const double exact = displacement(now.time);
    error = std::max(error, std::abs(now.displacement - exact));
    largest = std::max(largest, std::abs(exact));
  }
  return error / largest;
}

/// The scene's structure and excitation by themselves.
Scene bare(Scene scene, double duration) {
  scene.populations.clear();
  scene.time.duration = duration;
  return scene;
}

} // namespace

TEST_CASE("hard cases: a structure a thousand times lighter than its granules") {
  run_case("light structure", light_structure);
}
TEST_CASE("hard cases: a structure without stiffness") {
  run_case("structure without stiffness", free_structure);
}
TEST_CASE("hard cases: a structure without damping at resonance") {
  run_case("structure without damping", undamped_structure);
}
TEST_CASE("hard cases: a structure of 10 kHz") {
  run_case("structure of 10 kHz", fast_structure);
}

TEST_CASE("hard cases: these structures without granules follow their closed forms to 1e-6") {
  CaseReport report("bare structures");
  const auto check = [&](const char* name, const Scene& scene, const auto& displacement) {
    const double error = bare_error(scene, displacement);
    report.remark(fmt::format("{}: displacement off by {:.1e} of its largest", name, error));
    CHECK(error < 1.0e-6);
  };
  const double seconds = full_tests() ? 10.0 : 1.0;
  const Scene light = bare(light_structure(1, true), seconds);
  const ClosedForm light_form(*light.structure, 0.0, 0.0);
  check("light structure", light, [&](double t) { return light_form.displacement(t); });

  const Scene fast = bare(fast_structure(1, true), 0.1 * seconds);
  const ClosedForm fast_form(*fast.structure, *fast.excitation.force, fast.excitation.frequency);
  check("10 kHz", fast, [&](double t) { return fast_form.displacement(t); });

  check("without stiffness", bare(free_structure(1, true), seconds), [](double t) { return 1.0 * t; });

  // Resonance without damping: x = F / (2 M w) (sin(w t) / w - t cos(w t)).
  const Scene undamped = bare(undamped_structure(1, true), seconds);
  const double mass = undamped.structure->mass, rate = std::sqrt(undamped.structure->stiffness / mass);
  check("without damping, at resonance", undamped, [&](double t) {
    return *undamped.excitation.force / (2.0 * mass * rate) * (std::sin(rate * t) / rate - t * std::cos(rate * t));
  });
}

TEST_CASE("hard cases: one granule as wide as the box less 1 percent") {
  run_case("granule as wide as the box", tight_granule, true);
}
TEST_CASE("hard cases: one granule in a shaken cylinder") {
  run_case("one granule", lone_granule, true);
}

TEST_CASE("hard cases: zero granules, with all that a scene can say of them") {
  CaseReport report("zero granules");
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    Scene scene = undamped_structure(choice.seed, false);
    scene.populations[0].positions.clear();
    scene.populations[0].velocities.clear();
    scene.populations[0].spins.clear();
    scene.populations[0].count = 0;
    const Figures figures = watch(scene, choice);
    CHECK(figures.steps > 0);
    report.add(choice, figures);
  }
}

TEST_CASE("hard cases: without gravity and friction a granule between two walls keeps its beat") {
  // Elastic, head-on: back and forth between z = 0 and the lid in 2 (h - 2 r) / v and two contacts' durations.
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    const double radius = 1.5e-3, side = 0.02, speed = 1.0;
    Scene scene = box_scene(side, radius);
    make_lossless(scene);
    scene.contact.friction = FrictionLaw::none;
    add_granule(scene, {0.01, 0.01, 0.01}, {0.0, 0.0, speed});
    Choice frictionless = choice;
    frictionless.friction = FrictionLaw::none;
    const double beat = 2.0 * ((side - 2.0 * radius) / speed + wall_contact_duration(scene, speed));
    scene.time.duration = 20.0 * beat;
    apply(frictionless, scene);
    SolverRun run(scene);
    Simulation& simulation = run.simulation();
    while (!simulation.finished()) simulation.step();
    const GranuleTable end = simulation.granules();
    // The speed wanders by the integrator's error on each of 40 hits, and the beat with it.
    CHECK(end.velocity[0][2] == doctest::Approx(speed).epsilon(40.0 * allowed_rise(choice)));
    CHECK(std::abs(end.position[0][2] - 0.01) < 0.5 * 20.0 * beat * speed * allowed_rise(choice));
    CHECK(end.position[0][0] == 0.01);
    CHECK(end.position[0][1] == 0.01);
    CHECK(length(end.spin[0]) == 0.0);
  }
}
