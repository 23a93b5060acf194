#include "tests/hard_cases/scenes.hpp"

#include <cmath>
#include <numbers>

namespace grandamp::test {

namespace {

constexpr double pi = std::numbers::pi;

void set_restitution(Scene& scene, double restitution) {
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    constants->alpha.reset();
    constants->restitution = restitution;
  }
}

void prescribe_velocity(Scene& scene, double velocity, const Vector3& direction) {
  scene.excitation = Excitation{};
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.velocity = velocity;
  scene.excitation.direction = direction;
}

/// Shaken so that the peak acceleration is `gravities` times 9.81 m/s^2.
void shake(Scene& scene, double frequency, double gravities, const Vector3& direction) {
  scene.excitation = Excitation{};
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.frequency = frequency;
  scene.excitation.amplitude = gravities * 9.81 / (2.0 * pi * frequency) / (2.0 * pi * frequency);
  scene.excitation.direction = direction;
}

void place_by_count(Scene& scene, std::size_t count) {
  Population& population = scene.populations[0];
  population.placed = false;
  population.count = count;
}

/// 100 granules at 0.5 m/s in a cube that a structure carries along x.
Scene carried_gas(std::uint64_t seed, bool whole) {
  Scene scene = gas(100, 0.022, 0.5, seed);
  set_restitution(scene, 0.89);
  scene.time.impact_speed.reset();
  scene.time.duration = whole ? 0.2 : 0.01;
  scene.structure = Structure{};
  scene.structure->direction = {1.0, 0.0, 0.0};
  return scene;
}

} // namespace

Scene jerked_gas(std::uint64_t seed, bool whole) {
  Scene scene = gas(150, 0.03, 0.0, 30 + seed);
  prescribe_velocity(scene, 5.0, {1.0, 0.0, 0.0});
  scene.time.impact_speed.reset();
  scene.time.duration = whole ? 0.03 : 6.0e-3;
  return scene;
}

Scene jerked_bed(std::uint64_t seed, bool whole) {
  Scene scene = table_5(317, whole ? 0.05 : 0.01);
  scene.structure.reset();
  scene.time.impact_speed.reset();
  prescribe_velocity(scene, 5.0, seed % 2 ? Vector3{1.0, 0.0, 0.0} : Vector3{0.6, 0.8, 0.0});
  return scene;
}

Scene resting_bed(std::uint64_t, bool whole) {
  Scene scene = table_5(0, whole ? 10.0 : 0.3);
  place_by_count(scene, whole ? 317 : 98);
  scene.packing = PackingKind::settled;
  scene.structure.reset();
  scene.excitation = Excitation{};
  scene.time.impact_speed.reset();
  return scene;
}

Scene jammed_box(std::uint64_t, bool whole) {
  Scene scene = box_scene(0.03, 1.5e-3);
  set_restitution(scene, 0.89);
  scene.gravity = {0.0, 0.0, -9.81};
  place_by_count(scene, static_cast<std::size_t>(0.62 * 2.7e-5 / (4.0 / 3.0 * pi * 1.5e-3 * 1.5e-3 * 1.5e-3)));
  shake(scene, 200.0, 50.0, {0.0, 0.0, 1.0});
  scene.time.duration = whole ? 0.05 : 0.005;
  return scene;
}

Scene flung_gas(std::uint64_t seed, bool whole) {
  Scene scene = table_5(0, whole ? 4.0 : 0.4);
  Scene placed = gas(30, 0.025, 0.0, 60 + seed);
  scene.populations = placed.populations;
  set_restitution(scene, 0.97);
  scene.structure->damping = 0.02;
  scene.time.impact_speed.reset();
  return scene;
}

Scene size_contrast(std::uint64_t seed, bool whole) {
  const double large = 5.0e-3;
  Scene scene = box_scene(0.03, large);
  set_restitution(scene, 0.89);
  scene.gravity = {0.0, 0.0, -9.81};
  Population& big = scene.populations[0];
  big.name = "big";
  for (const double x : {0.008, 0.022})
    for (const double y : {0.008, 0.022}) add_granule(scene, {x, y, 0.006 + 1.0e-4 * static_cast<double>(seed)});
  Population small = scene.populations[0];
  small.name = "small";
  small.radius = 0.1 * large;
  small.mass = sphere_mass(small.radius);
  small.placed = false;
  small.positions.clear();
  small.velocities.clear();
  small.spins.clear();
  small.count = 1500;
  scene.populations.push_back(small);
  shake(scene, 50.0, 3.0, {0.0, 0.0, 1.0});
  scene.time.duration = whole ? 0.04 : 5.0e-3;
  return scene;
}

Scene light_structure(std::uint64_t seed, bool whole) {
  Scene scene = carried_gas(seed, whole);
  scene.structure->mass = 100.0 * sphere_mass(1.5e-3) / 1000.0;
  const double rate = 2.0 * pi * 16.0;
  scene.structure->stiffness = scene.structure->mass * rate * rate;
  scene.structure->damping = 0.02 * scene.structure->mass * rate;
  scene.structure->displacement = 1.0e-3;
  if (!whole) scene.time.duration = 2.0e-3;
  return scene;
}

Scene free_structure(std::uint64_t seed, bool whole) {
  Scene scene = carried_gas(seed, whole);
  scene.structure->mass = 0.01;
  scene.structure->velocity = 1.0;
  return scene;
}

Scene undamped_structure(std::uint64_t seed, bool whole) {
  Scene scene = carried_gas(seed, whole);
  scene.structure->mass = 0.01;
  scene.structure->stiffness = 400.0;
  scene.excitation.kind = ExcitationKind::harmonic;
  scene.excitation.force = 0.2;
  scene.excitation.frequency = std::sqrt(400.0 / 0.01) / (2.0 * pi);
  return scene;
}

Scene fast_structure(std::uint64_t seed, bool whole) {
  Scene scene = carried_gas(seed, whole);
  scene.structure->mass = 0.01;
  const double rate = 2.0 * pi * 1.0e4;
  scene.structure->stiffness = scene.structure->mass * rate * rate;
  scene.structure->damping = 0.01 * scene.structure->mass * rate;
  scene.excitation.kind = ExcitationKind::harmonic;
  scene.excitation.force = 20.0;
  scene.excitation.frequency = 1.0e4;
  return scene;
}

Scene tight_granule(std::uint64_t seed, bool whole) {
  const double radius = 1.5e-3, side = 2.0 * radius / 0.99;
  Scene scene = box_scene(side, radius);
  set_restitution(scene, 0.89);
  scene.gravity = {0.0, 0.0, -9.81};
  add_granule(scene, {0.5 * side, 0.5 * side + 1.0e-6 * static_cast<double>(seed), 0.5 * side});
  shake(scene, 50.0, 4.0, {0.6, 0.0, 0.8});
  scene.time.duration = whole ? 1.0 : 0.05;
  return scene;
}

Scene lone_granule(std::uint64_t seed, bool whole) {
  Scene scene = box_scene(0.02, 1.5e-3);
  set_restitution(scene, 0.89);
  scene.enclosure.shape = EnclosureShape::cylinder;
  scene.enclosure.diameter = 0.02;
  scene.enclosure.height = 0.02;
  scene.gravity = {-9.81, 0.0, 0.0};
  add_granule(scene, {0.0101, 0.0099, 0.01}, {0.1, 0.05 * static_cast<double>(seed), 0.3}, {20.0, 10.0, -5.0});
  shake(scene, 30.0, 4.0, {1.0, 0.0, 0.0});
  scene.time.duration = whole ? 1.0 : 0.05;
  return scene;
}

Scene one_big(std::uint64_t seed, bool whole) {
  const double small_radius = 0.5e-3, big_radius = 10.0e-3;
  const double side = whole ? 0.06 : 0.036;
  Scene scene = box_scene(side, big_radius);
  set_restitution(scene, 0.89);
  scene.gravity = {0.0, 0.0, -9.81};
  scene.populations[0].name = "big";
  add_granule(scene, {0.5 * side, 0.5 * side, 0.5 * side + 1.0e-4 * static_cast<double>(seed)});
  Population small = scene.populations[0];
  small.name = "small";
  small.radius = small_radius;
  small.mass = sphere_mass(small_radius);
  small.placed = false;
  small.positions.clear();
  small.velocities.clear();
  small.spins.clear();
  small.speed = 0.1;
  small.count = whole ? 100000 : 3000;
  scene.populations.push_back(small);
  scene.time.duration = whole ? 3.0e-4 : 1.0e-3;
  return scene;
}

const std::vector<HardScene>& hard_scenes() {
  static const std::vector<HardScene> scenes{{"at rest, jerked", jerked_gas},
                                             {"bed at rest, jerked", jerked_bed},
                                             {"bed at rest", resting_bed},
                                             {"jammed", jammed_box},
                                             {"flung at resonance", flung_gas},
                                             {"sizes 1:10", size_contrast},
                                             {"light structure", light_structure},
                                             {"structure without stiffness", free_structure},
                                             {"structure without damping", undamped_structure},
                                             {"structure of 10 kHz", fast_structure},
                                             {"granule as wide as the box", tight_granule},
                                             {"one granule", lone_granule},
                                             {"one big granule", one_big}};
  return scenes;
}

} // namespace grandamp::test
