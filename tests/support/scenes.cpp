#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace grandamp::test {

namespace {

/// The same numbers on every machine (the standard's distributions are not).
class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  Vector3 in_unit_ball() {
    while (true) {
      const Vector3 point{uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)};
      const double square = point[0] * point[0] + point[1] * point[1] + point[2] * point[2];
      if (square <= 1.0 && square > 1.0e-4) return point;
    }
  }
  Vector3 direction() {
    Vector3 point = in_unit_ball();
    const double length = std::hypot(point[0], point[1], point[2]);
    for (double& component : point) component /= length;
    return point;
  }

private:
  std::mt19937_64 engine_;
};

Vector3 scaled(double s, const Vector3& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
Vector3 sum(const Vector3& a, const Vector3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// A random place in the cube, clear of the granules already there.
Vector3 free_place(Random& random, const std::vector<Vector3>& others, const Vector3& low, const Vector3& high,
                   double clearance) {
  for (int attempt = 0; attempt < 1000000; ++attempt) {
    const Vector3 place{random.uniform(low[0], high[0]), random.uniform(low[1], high[1]),
                        random.uniform(low[2], high[2])};
    bool clear = true;
    for (const Vector3& other : others)
      clear = clear && std::hypot(other[0] - place[0], other[1] - place[1], other[2] - place[2]) > clearance;
    if (clear) return place;
  }
  throw std::runtime_error("no room for another granule");
}

} // namespace

double sphere_mass(double radius, double density) {
  return density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

Contact acrylic_contact() {
  Contact contact;
  contact.granule.stiffness = 1.0e7;
  contact.granule.reference_radius = 3.0e-3;
  contact.granule.alpha = 0.077;
  contact.granule.friction = 0.52;
  contact.wall = contact.granule;
  contact.wall->stiffness = 1.3e7;
  return contact;
}

Scene box_scene(double side, double radius) {
  Scene scene;
  scene.enclosure.size = {side, side, side};
  scene.packing = PackingKind::random;
  scene.contact = acrylic_contact();
  Population population;
  population.name = "acrylic";
  population.radius = radius;
  population.mass = sphere_mass(radius);
  population.placed = true;
  scene.populations.push_back(population);
  scene.output.checkpoint_interval = 0.0;
  return scene;
}

void make_lossless(Scene& scene) {
  scene.contact.damping = NormalDamping::none;
  scene.contact.friction = FrictionLaw::none;
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    constants->restitution.reset();
    constants->alpha.reset();
    constants->friction.reset();
  }
}

void add_granule(Scene& scene, const Vector3& position, const Vector3& velocity, const Vector3& spin) {
  Population& population = scene.populations.front();
  population.positions.push_back(position);
  population.velocities.push_back(velocity);
  population.spins.push_back(spin);
  population.count = population.positions.size();
}

double contact_duration(double mass, double stiffness, double closing_speed) {
  return 3.2180 * std::pow(mass * mass / (stiffness * stiffness * closing_speed), 0.2);
}

double pair_contact_duration(const Scene& scene, double closing_speed) {
  const Population& population = scene.populations.front();
  const ContactConstants& law = scene.contact.granule;
  return contact_duration(0.5 * population.mass, *law.stiffness * std::sqrt(population.radius / *law.reference_radius),
                          closing_speed);
}

double wall_contact_duration(const Scene& scene, double closing_speed) {
  const Population& population = scene.populations.front();
  const ContactConstants& law = *scene.contact.wall;
  return contact_duration(population.mass, *law.stiffness * std::sqrt(population.radius / *law.reference_radius),
                          closing_speed);
}

double shortest_contact_duration(const Scene& scene, double closing_speed) {
  return std::min(pair_contact_duration(scene, closing_speed), wall_contact_duration(scene, closing_speed));
}

Scene two_granules(double radius, double speed, double gap, const Vector3& direction) {
  const double side = 40.0 * radius;
  Scene scene = box_scene(side, radius);
  const Vector3 centre{0.5 * side, 0.5 * side, 0.5 * side};
  const double offset = radius + 0.5 * gap;
  add_granule(scene, sum(centre, scaled(-offset, direction)), scaled(speed, direction));
  add_granule(scene, sum(centre, scaled(offset, direction)), scaled(-speed, direction));
  scene.time.impact_speed = 2.0 * speed;
  scene.time.duration = 1.5 * pair_contact_duration(scene, 2.0 * speed) + gap / (2.0 * speed);
  return scene;
}

Scene granule_and_floor(double radius, double gap, const Vector3& velocity, const Vector3& spin) {
  const double side = 40.0 * radius;
  Scene scene = box_scene(side, radius);
  add_granule(scene, {0.5 * side, 0.5 * side, radius + gap}, velocity, spin);
  const double speed = -velocity[2];
  if (speed > 0.0) {
    scene.time.impact_speed = speed;
    scene.time.duration = 1.5 * wall_contact_duration(scene, speed) + gap / speed;
  }
  return scene;
}

Scene gas(std::size_t count, double side, double speed, std::uint64_t seed) {
  const double radius = 1.5e-3;
  Scene scene = box_scene(side, radius);
  Random random(seed);
  const Vector3 low{1.01 * radius, 1.01 * radius, 1.01 * radius};
  const Vector3 high{side - low[0], side - low[1], side - low[2]};
  for (std::size_t n = 0; n < count; ++n) {
    const Vector3 place = free_place(random, scene.populations[0].positions, low, high, 2.01 * radius);
    add_granule(scene, place, scaled(speed, random.direction()));
  }
  scene.time.impact_speed = 2.0 * speed;
  return scene;
}

Scene imploding_cluster(std::size_t count, std::uint64_t seed) {
  const double radius = 1.5e-3, side = 0.2, half = 0.012;
  Scene scene = box_scene(side, radius);
  Random random(seed);
  const double middle = 0.5 * side;
  const Vector3 low{middle - half, middle - half, middle - half}, high{middle + half, middle + half, middle + half};
  for (std::size_t n = 0; n < count; ++n) {
    const Vector3 place = free_place(random, scene.populations[0].positions, low, high, 2.01 * radius);
    const Vector3 inward{middle - place[0], middle - place[1], middle - place[2]};
    add_granule(scene, place, sum(scaled(150.0, inward), scaled(0.3, random.direction())),
                scaled(300.0, random.direction()));
  }
  scene.time.impact_speed = 5.0;
  return scene;
}

Scene table_5(std::size_t count, double duration) {
  return vertical_damper(count, 1.85e-3, 15.91, duration);
}

Scene vertical_damper(std::size_t count, double radius, double frequency, double duration) {
  Scene scene = box_scene(1.0, radius);
  scene.gravity = {0.0, 0.0, -9.81};
  scene.enclosure.size = {0.025, 0.025, 0.0359};
  scene.contact.granule.alpha.reset();
  scene.contact.granule.restitution = 0.89;
  scene.contact.wall->alpha.reset();
  scene.contact.wall->restitution = 0.89;
  scene.structure = bare_structure().structure;
  scene.excitation = bare_structure().excitation;
  scene.excitation.frequency = frequency;
  scene.time.duration = duration;
  scene.time.impact_speed = 2.0;

  // The lattice's gaps are small enough to settle soon, and the jitter keeps contacts generic.
  Random random(5);
  const double pitch = 2.0 * radius + 0.06e-3, jitter = 0.02e-3;
  const auto across = static_cast<std::size_t>((0.025 - 2.0 * radius) / pitch) + 1;
  const double margin = 0.5 * (0.025 - static_cast<double>(across - 1) * pitch);
  for (std::size_t n = 0; n < count; ++n) {
    const auto column = static_cast<double>(n % across), row = static_cast<double>(n / across % across);
    const auto layer = static_cast<double>(n / across / across);
    const Vector3 shift = scaled(jitter, random.in_unit_ball());
    add_granule(scene, {margin + pitch * column + shift[0], margin + pitch * row + shift[1],
                        radius + 0.03e-3 + pitch * layer + shift[2]});
  }
  return scene;
}

Scene bare_structure() {
  Scene scene;
  scene.enclosure.size = {0.025, 0.025, 0.0359};
  scene.packing = PackingKind::random;
  scene.structure = Structure{};
  scene.structure->mass = 0.1;
  scene.structure->stiffness = 1000.0;
  scene.structure->damping = 0.2;
  scene.structure->direction = {0.0, 0.0, 1.0};
  scene.excitation.kind = ExcitationKind::harmonic;
  scene.excitation.static_deflection = 0.5e-3;
  scene.excitation.frequency = 15.91;
  scene.output.checkpoint_interval = 0.0;
  return scene;
}

} // namespace grandamp::test
