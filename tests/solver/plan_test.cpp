// What a plan tells, and what a Scene filled in by a program may get wrong.
#include "solver/measures.hpp"
#include "solver/plan.hpp"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <limits>

using namespace grandamp;

namespace {

using Names = std::vector<std::string>;

Scene damper() {
  Scene scene;
  scene.gravity = {0.0, 0.0, -9.81};
  scene.enclosure.size = {0.025, 0.025, 0.0359};
  Population acrylic;
  acrylic.name = "acrylic";
  acrylic.count = 317;
  acrylic.radius = 1.85e-3;
  acrylic.mass = 1190.0 * sphere_volume(1.85e-3);
  scene.populations = {acrylic};
  scene.contact.granule.stiffness = 1.0e7;
  scene.contact.granule.reference_radius = 3.0e-3;
  scene.contact.granule.restitution = 0.89;
  scene.contact.granule.friction = 0.52;
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

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Names faults(const Scene& scene) {
  Names keys;
  try {
    make_plan(scene);
  } catch (const SceneError& error) {
    for (const Problem& problem : error.problems()) {
      keys.push_back(problem.key);
      CHECK_FALSE(problem.message.empty());
    }
  }
  return keys;
}

} // namespace

TEST_CASE(
    "plan: the skin goes by the mean diameter, under a fixed interval by the largest, and a given cell is for all") {
  Scene scene = damper();
  scene.populations[0].count = 10;
  const double alike = make_plan(scene).skin / 1.85e-3;
  Population small = scene.populations[0];
  small.name = "small";
  small.count = 5000;
  small.radius = 0.2e-3;
  small.mass = 1190.0 * sphere_volume(small.radius);
  scene.populations.push_back(small);
  const double mean = (10 * 1.85e-3 + 5000 * 0.2e-3) / 5010;
  const Plan plan = make_plan(scene);
  CHECK(plan.mean_radius == doctest::Approx(mean));
  CHECK(plan.skin == doctest::Approx(alike * mean).epsilon(0.02)); // a little denser than without the small ones
  CHECK(plan.small_radius == 0.2e-3);
  CHECK(plan.cell == doctest::Approx(0.4e-3 + plan.skin));
  scene.verlet.policy = ListPolicy::fixed;
  CHECK(make_plan(scene).skin == doctest::Approx(alike * 1.85e-3).epsilon(0.02));
  scene.verlet.policy = ListPolicy::guarded;
  scene.verlet.cell = 1.2;
  CHECK(make_plan(scene).small_radius == 1.85e-3);
  CHECK(make_plan(scene).cell == doctest::Approx(1.2 * 3.7e-3));
}

TEST_CASE("the plan of a damper") {
  const Plan plan = make_plan(damper());
  CHECK(plan.granules == 317);
  CHECK(plan.window == std::array<double, 2>{3.5, 7.0});
  CHECK(plan.effects ==
        Names{"hertz", "tsuji", "coulomb", "rotation", "gravity", "box", "structure", "harmonic", "energy"});
  for (const char* name : {"spring", "linear", "polydisperse", "materials", "cylinder", "prescribed", "base", "chirp",
                           "random", "impulse", "table", "audit", "verlet", "mixed"})
    CHECK(has(plan.effects_left_out, name));
  CHECK(plan.time_step * static_cast<double>(plan.steps) == doctest::Approx(7.0).epsilon(1e-15));
  CHECK(plan.skin_tuned);
  CHECK(plan.skin == doctest::Approx(0.2 * 3.7e-3));
  CHECK(plan.cell >= 3.7e-3 + plan.skin);
  CHECK(plan.grid == std::array<int, 3>{5, 5, 8});
  CHECK(plan.memory > 317 * 204);
  CHECK_FALSE(plan.notes.empty());
  CHECK(plan.damper.granule_mass == doctest::Approx(317 * 1190.0 * 4.0 / 3.0 * 3.14159265 * std::pow(1.85e-3, 3)));
  CHECK(plan.damper.mass_ratio == doctest::Approx(plan.damper.granule_mass / 0.1));
  CHECK(plan.damper.fill_fraction == doctest::Approx(0.3747).epsilon(1e-3));
  CHECK(plan.damper.clearance == doctest::Approx(0.0359 * (1.0 - 0.3747 / 0.6)).epsilon(1e-3));
  CHECK(plan.damper.natural_frequency == doctest::Approx(15.9155).epsilon(1e-5));
  CHECK(plan.damper.loaded_frequency ==
        doctest::Approx(15.9155 / std::sqrt(1.0 + plan.damper.mass_ratio)).epsilon(1e-5));
  CHECK(plan.damper.acceleration ==
        doctest::Approx(0.02499 * std::pow(2.0 * 3.14159265 * 15.91, 2) / 9.81).epsilon(1e-3));
}

TEST_CASE("mixed precision is an effect, and refused by its key where there is none") {
  Scene scene = damper();
  scene.time.precision = Precision::mixed;
  CHECK(has(make_plan(scene).effects, "mixed"));
  scene.contact.friction = FrictionLaw::none;
  scene.contact.granule.friction.reset();
  if (scene.contact.wall) scene.contact.wall->friction.reset();
  CHECK(faults(scene).empty());
  scene.contact.tension = false;
  CHECK(faults(scene) == Names{"time.precision"});
  scene = damper();
  scene.time.precision = Precision::mixed;
  scene.contact.friction = FrictionLaw::spring;
  CHECK(has(faults(scene), "time.precision"));
  scene.time.precision = Precision::full;
  CHECK_FALSE(has(faults(scene), "time.precision"));
}

TEST_CASE("effects follow from the scene") {
  Scene scene = damper();
  Population steel = scene.populations[0];
  steel.count = 5;
  steel.mass *= 6.0;
  scene.populations.push_back(steel);
  CHECK(has(make_plan(scene).effects, "polydisperse"));
  CHECK_FALSE(has(make_plan(scene).effects, "materials"));
  for (Population& population : scene.populations) population.poisson = 0.3;
  scene.populations[0].young = 3.0e9;
  scene.populations[1].young = 2.0e11;
  scene.contact.granule.stiffness.reset();
  scene.contact.granule.reference_radius.reset();
  CHECK(has(make_plan(scene).effects, "materials"));
  scene.contact.friction = FrictionLaw::none;
  CHECK_FALSE(has(make_plan(scene).effects, "rotation"));
  scene.populations.clear();
  const Plan bare = make_plan(scene);
  CHECK(bare.effects == Names{"structure", "harmonic", "energy"});
  CHECK(bare.memory == 0);
  CHECK(bare.contact_duration == 0.0);
}

TEST_CASE("what the list policy asks for") {
  Scene scene = damper();
  scene.verlet.policy = ListPolicy::none;
  CHECK(make_plan(scene).skin == 0.0);
  CHECK_FALSE(make_plan(scene).skin_tuned);
  scene.verlet.policy = ListPolicy::guarded;
  scene.verlet.skin = 0.1;
  CHECK(make_plan(scene).skin == doctest::Approx(0.1 * 3.7e-3));
  CHECK_FALSE(make_plan(scene).skin_tuned);
  scene.verlet.skin.reset();
  scene.verlet.cell = 1.1;
  CHECK(make_plan(scene).skin <= 0.1 * 3.7e-3 * (1.0 + 1e-12));
}

TEST_CASE("each fault is told by its key") {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  struct Bad {
    const char* key;
    std::function<void(Scene&)> spoil;
  };
  const Bad table[] = {
      {"gravity.1", [&](Scene& s) { s.gravity[1] = nan; }},
      {"enclosure.size.0", [&](Scene& s) { s.enclosure.size[0] = 0.0; }},
      {"enclosure.size.2", [&](Scene& s) { s.enclosure.size[2] = infinite; }},
      {"enclosure.diameter", [&](Scene& s) { s.enclosure.shape = EnclosureShape::cylinder; }},
      {"granules.0.radius", [&](Scene& s) { s.populations[0].radius = -1.0; }},
      {"granules.0.radius", [&](Scene& s) { s.populations[0].radius = 0.0126; }},
      {"granules.0.mass", [&](Scene& s) { s.populations[0].mass = nan; }},
      {"granules.0.speed", [&](Scene& s) { s.populations[0].speed = 1.0; }},
      {"granules.0.count", [&](Scene& s) { s.populations[0].count = std::size_t{1} << 31; }},
      {"granules.1.count",
       [&](Scene& s) {
         s.populations.resize(2, s.populations[0]);
         s.populations[1].count = SIZE_MAX;
       }},
      {"granules", [&](Scene& s) { s.populations[0].count = 600; }},
      {"granules.0.positions", [&](Scene& s) { s.populations[0].placed = true; }},
      {"granules.0.velocities", [&](Scene& s) { s.populations[0].velocities.resize(3); }},
      {"granules.0.radii", [&](Scene& s) { s.populations[0].radii.resize(3, 1.0e-3); }},
      {"packing.kind",
       [&](Scene& s) {
         s.gravity = {0.0, 0.0, 0.0};
       }},
      {"contact.granule.restitution", [&](Scene& s) { s.contact.granule.restitution.reset(); }},
      {"contact.granule.restitution", [&](Scene& s) { s.contact.granule.restitution = 0.0; }},
      {"contact.granule.friction", [&](Scene& s) { s.contact.granule.friction = -0.1; }},
      {"contact.granule.stiffness", [&](Scene& s) { s.contact.granule.stiffness = nan; }},
      {"granules.0.young", [&](Scene& s) { s.contact.granule.stiffness.reset(); }},
      {"structure.mass", [&](Scene& s) { s.structure->mass = 0.0; }},
      {"structure.stiffness", [&](Scene& s) { s.structure->stiffness = -1.0; }},
      {"structure.damping", [&](Scene& s) { s.structure->damping = nan; }},
      {"structure.direction",
       [&](Scene& s) {
         s.structure->direction = {1.0, 1.0, 0.0};
       }},
      {"structure.velocity", [&](Scene& s) { s.structure->velocity = infinite; }},
      {"excitation.kind", [&](Scene& s) { s.structure.reset(); }},
      {"excitation.kind", [&](Scene& s) { s.excitation.kind = ExcitationKind::prescribed; }},
      {"excitation.force", [&](Scene& s) { s.excitation.force = 1.0; }},
      {"excitation.force", [&](Scene& s) { s.excitation.static_deflection.reset(); }},
      {"excitation.frequency", [&](Scene& s) { s.excitation.frequency = 0.0; }},
      {"time.duration", [&](Scene& s) { s.time.duration = 0.0; }},
      {"time.duration", [&](Scene& s) { s.time.duration = 1.0e300; }},
      {"time.steps_per_contact", [&](Scene& s) { s.time.steps_per_contact = 1.0; }},
      {"time.steps_per_contact", [&](Scene& s) { s.time.steps_per_contact = nan; }},
      {"time.step", [&](Scene& s) { s.time.step = 1.0; }},
      {"time.step", [&](Scene& s) { s.time.step = 8.0; }},
      {"time.impact_speed", [&](Scene& s) { s.time.impact_speed = 0.0; }},
      {"verlet.skin", [&](Scene& s) { s.verlet.skin = -0.1; }},
      {"verlet.cell", [&](Scene& s) { s.verlet.cell = 0.9; }},
      {"verlet.safety", [&](Scene& s) { s.verlet.safety = 0.0; }},
      {"verlet.max_interval", [&](Scene& s) { s.verlet.max_interval = 0; }},
      {"verlet.interval", [&](Scene& s) { s.verlet.interval = -3; }},
      {"verlet.audit", [&](Scene& s) { s.verlet.audit = -1; }},
      {"output.history_interval", [&](Scene& s) { s.output.history_interval = 0.0; }},
      {"output.window",
       [&](Scene& s) {
         s.output.window = std::array<double, 2>{3.0, 2.0};
       }},
      {"output.window",
       [&](Scene& s) {
         s.output.window = std::array<double, 2>{3.0, 7.1};
       }},
  };
  CHECK(faults(damper()).empty());
  for (const Bad& bad : table) {
    Scene scene = damper();
    bad.spoil(scene);
    const Names keys = faults(scene);
    CAPTURE(bad.key);
    CAPTURE(keys);
    CHECK(has(keys, bad.key));
  }
}

TEST_CASE("all faults at once") {
  Scene scene = damper();
  scene.enclosure.size[1] = -1.0;
  scene.structure->mass = 0.0;
  scene.contact.granule.friction.reset();
  scene.time.duration = std::nan("");
  CHECK(faults(scene).size() >= 4);
}
