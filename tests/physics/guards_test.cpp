// A run that would go wrong stops, and says what happened, to whom, when, and what to change.
#include "solver/errors.hpp"
#include "solver/run_state.hpp"
#include "solver/simulation.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <optional>
#include <string>

namespace grandamp::test {

namespace {

/// Two granules that meet head-on in the middle of a box, at 2.5 m/s each.
Scene head_on(double stiffness) {
  Scene scene;
  scene.enclosure.size = {0.02, 0.01, 0.01};
  Population pair;
  pair.name = "acrylic";
  pair.placed = true;
  pair.count = 2;
  pair.radius = 1.5e-3;
  pair.mass = 1190.0 * 4.0 / 3.0 * std::numbers::pi * 1.5e-3 * 1.5e-3 * 1.5e-3;
  pair.positions = {{0.008, 0.005, 0.005}, {0.012, 0.005, 0.005}};
  pair.velocities = {{2.5, 0.0, 0.0}, {-2.5, 0.0, 0.0}};
  scene.populations.push_back(pair);
  scene.contact.granule.stiffness = stiffness;
  scene.contact.granule.reference_radius = 3.0e-3;
  scene.contact.granule.restitution = 0.9;
  scene.contact.granule.friction = 0.5;
  scene.time.duration = 2.0e-3;
  return scene;
}

/// What stopped the run; empty if nothing did.
std::string stopped_by(Simulation& simulation) {
  try {
    while (!simulation.finished()) simulation.step();
  } catch (const GuardError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("guards: an ordinary hit stops nothing and warns of nothing") {
  Simulation simulation(head_on(1.0e7));
  CHECK(stopped_by(simulation).empty());
  CHECK(simulation.take_warnings().empty());
  CHECK(simulation.guards().max_closing == doctest::Approx(5.0).epsilon(1e-3));
  CHECK(simulation.guards().max_overlap > 0.0);
  CHECK(simulation.guards().max_overlap < 0.1);
}

TEST_CASE("guards: a closing speed far above the step's stops the run and names the key") {
  Scene scene = head_on(1.0e7);
  scene.time.impact_speed = 0.05; // 100 times too slow: some 3 steps a contact
  Simulation simulation(scene);
  const std::string what = stopped_by(simulation);
  CAPTURE(what);
  CHECK(contains(what, "closed at 5 m/s"));
  CHECK(contains(what, "time.impact_speed"));
  CHECK(contains(what, "t = "));
}

TEST_CASE("guards: a closing speed above the step's is told once") {
  Scene scene = head_on(1.0e7);
  scene.time.impact_speed = 2.0;
  Simulation simulation(scene);
  CHECK(stopped_by(simulation).empty());
  const auto warnings = simulation.take_warnings();
  REQUIRE(warnings.size() == 1);
  CHECK(contains(warnings.front(), "faster than the 2 m/s"));
  CHECK(simulation.take_warnings().empty());
}

TEST_CASE("guards: a deep overlap is told, one beyond half a radius stops the run and names both granules") {
  Simulation soft(head_on(2.0e5));
  CHECK(stopped_by(soft).empty());
  CHECK(soft.guards().max_overlap > 0.1);
  const auto warnings = soft.take_warnings();
  REQUIRE(warnings.size() == 1);
  CHECK(contains(warnings.front(), "deep for Hertz"));

  Simulation softest(head_on(2.0e3));
  const std::string what = stopped_by(softest);
  CAPTURE(what);
  CHECK(contains(what, "an overlap of "));
  CHECK(contains(what, "granule 0 (acrylic)"));
  CHECK(contains(what, "granule 1 (acrylic)"));
  CHECK(contains(what, "stiffness"));
}

TEST_CASE("guards: the first granule whose speed is no number is named, with its neighbours and the overlap") {
  Scene scene = head_on(1.0e7);
  Simulation simulation(scene);
  while (simulation.guards().max_overlap == 0.0) simulation.step();
  for (int n = 0; n < 3; ++n) simulation.step(); // in touch
  // Both speeds are numbers still, but no longer their squares.
  RunState state = simulation.state();
  for (std::size_t row = 0; row < 2; ++row) state.velocity[3 * row] = 1.0e180;
  Simulation spoilt(scene, state);
  const std::string what = stopped_by(spoilt);
  CAPTURE(what);
  CHECK(contains(what, "a velocity is not finite at t = "));
  CHECK(contains(what, "granule 0 (acrylic)"));
  CHECK(contains(what, "granule 1 (not finite either)"));
  CHECK(contains(what, "the deepest overlap met so far is"));
  CHECK(contains(what, "time.impact_speed"));
}

TEST_CASE("guards: an energy balance that the step does not explain is told once, and a good one never") {
  for (const bool spoilt : {false, true}) {
    CAPTURE(spoilt);
    Scene scene = head_on(1.0e7);
    Simulation simulation(scene);
    std::size_t warnings = 0;
    std::int64_t step = 0;
    Simulation* run = &simulation;
    std::optional<Simulation> other;
    while (!run->finished()) {
      run->step_and_sample();
      if (++step == 40 && spoilt) { // energy from nowhere
        RunState state = run->state();
        for (double& v : state.velocity) v *= 1.2;
        other.emplace(scene, state);
        run = &*other;
      }
      for (const std::string& warning : run->take_warnings())
        warnings += contains(warning, "the energy balance is off") ? 1 : 0;
    }
    CHECK(warnings == (spoilt ? 1 : 0));
  }
}

} // namespace grandamp::test
