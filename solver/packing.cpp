#include "solver/packing.hpp"

#include "solver/measures.hpp"
#include "solver/packing_parts.hpp"

#include <fmt/format.h>

namespace grandamp {

namespace packing {

Room::Room(const Enclosure& enclosure)
    : cylinder_(enclosure.shape == EnclosureShape::cylinder), axis_(static_cast<std::size_t>(enclosure.axis)),
      diameter_(enclosure.diameter), box_(bounding_box(enclosure)), volume_(volume_of(enclosure)) {}

double Room::to_wall(const Vector3& p) const {
  double nearest = INFINITY, square = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (cylinder_ && k != axis_)
      square += (p[k] - 0.5 * diameter_) * (p[k] - 0.5 * diameter_);
    else
      nearest = std::min({nearest, p[k], box_[k] - p[k]});
  }
  return cylinder_ ? std::min(nearest, 0.5 * diameter_ - std::sqrt(square)) : nearest;
}

Vector3 Room::confined(const Vector3& p, double radius) const {
  Vector3 inside = p;
  double square = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (cylinder_ && k != axis_)
      square += (p[k] - 0.5 * diameter_) * (p[k] - 0.5 * diameter_);
    else if (box_[k] - radius > radius)
      inside[k] = std::clamp(p[k], radius, box_[k] - radius);
    else
      inside[k] = 0.5 * box_[k];
  }
  if (!cylinder_) return inside;
  // A hair less than the radius, so that rounding leaves it inside.
  const double free = std::max(0.0, 0.5 * diameter_ - radius) * (1.0 - 1.0e-12);
  const double distance = std::sqrt(square);
  if (distance > free)
    for (std::size_t k = 0; k < 3; ++k)
      if (k != axis_) inside[k] = 0.5 * diameter_ + (p[k] - 0.5 * diameter_) * (free / distance);
  return inside;
}

Vector3 Room::random_place(RandomNumbers& random, double radius) const {
  for (;;) {
    Vector3 p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = random.uniform(radius, std::max(radius, box_[k] - radius));
    if (!cylinder_ || to_wall(p) >= radius) return p;
    if (0.5 * diameter_ - radius < 1.0e-9 * radius) return confined(p, radius); // only the axis is left
  }
}

} // namespace packing

namespace {

using packing::Room;
using packing::Spheres;

constexpr std::size_t most_told = 10; ///< faults of one kind, of a file with thousands

struct Name {
  std::size_t population;
  std::size_t index;
};

/// Everything but positions, by id in scene order; explicit positions as they are.
Placement lay_out(const Scene& scene, Spheres& spheres, std::vector<Name>& names) {
  RandomNumbers random(scene.seed, 1);
  Placement placement;
  const std::size_t count = granule_count(scene);
  names.reserve(count);
  spheres.position.reserve(count);
  spheres.radius.reserve(count);
  spheres.placed.reserve(count);
  placement.mass.reserve(count);
  placement.population.reserve(count);
  placement.velocity.reserve(count);
  placement.spin.reserve(count);
  for (std::size_t a = 0; a < scene.populations.size(); ++a) {
    const Population& population = scene.populations[a];
    for (std::size_t i = 0; i < population.count; ++i) {
      names.push_back({a, i});
      spheres.position.push_back(population.placed ? population.positions[i] : Vector3{});
      spheres.radius.push_back(radius_of(population, i));
      spheres.placed.push_back(population.placed);
      placement.mass.push_back(mass_of(population, i));
      placement.population.push_back(static_cast<std::int32_t>(a));
      Vector3 velocity{0.0, 0.0, 0.0};
      if (!population.velocities.empty())
        velocity = population.velocities[i];
      else if (population.speed > 0.0) {
        velocity = random.direction();
        for (double& component : velocity) component *= population.speed;
      }
      placement.velocity.push_back(velocity);
      placement.spin.push_back(population.spins.empty() ? Vector3{0.0, 0.0, 0.0} : population.spins[i]);
    }
  }
  placement.radius = spheres.radius;
  return placement;
}

std::string told(const Vector3& p) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", p[0], p[1], p[2]);
}

/// Explicit positions: inside, and apart. Small overlaps relax by themselves and are only noted.
void check_explicit(const Room& room, const Spheres& spheres, const std::vector<Name>& names, Placement& placement) {
  std::vector<Problem> faults;
  std::size_t slight = 0;
  const auto key = [&](std::size_t id) {
    return fmt::format("granules.{}.positions.{}", names[id].population, names[id].index);
  };
  const auto fault = [&](std::size_t id, std::string message, std::string allowed) {
    if (faults.size() < most_told)
      faults.push_back({key(id), told(spheres.position[id]), std::move(message), std::move(allowed)});
  };
  SphereGrid grid(room.box(), spheres.position, spheres.radius);
  for (std::size_t i = 0; i < spheres.radius.size(); ++i) {
    if (!spheres.placed[i]) continue;
    const double radius = spheres.radius[i], crossing = radius - room.to_wall(spheres.position[i]);
    if (crossing > radius)
      fault(i, fmt::format("granule {} is outside the enclosure", i), "centres a radius from every wall");
    else if (crossing > 0.1 * radius)
      fault(i, fmt::format("granule {} crosses a wall by {:.3g} of its radius", i, crossing / radius),
            "at most 0.1 of the radius");
    else if (crossing > 1.0e-9 * radius)
      ++slight;
    grid.visit_near(spheres.position[i], radius, 0.0, [&](std::size_t j, double square) {
      const double distance = std::sqrt(square), smaller = std::min(radius, spheres.radius[j]);
      const double overlap = (radius + spheres.radius[j] - distance) / smaller;
      if (distance < 1.0e-9 * smaller)
        fault(i, fmt::format("granules {} and {} have one centre", j, i), "centres apart");
      else if (overlap >= 0.5 * (1.0 - 1.0e-9))
        fault(i, fmt::format("granules {} and {} overlap by {:.3g} of the smaller radius", j, i, overlap),
              "below 0.5 of the smaller radius");
      else if (overlap > 1.0e-9)
        ++slight;
      return true;
    });
    grid.insert(i);
  }
  if (!faults.empty()) throw SceneError(std::move(faults));
  if (slight == 0) return;
  Problem note{
      "granules", "",
      fmt::format("{} small overlaps among the explicit positions and with walls; they push apart at the start",
                  slight),
      ""};
  note.note = true;
  placement.notes.push_back(std::move(note));
}

[[noreturn]] void refuse(const Plan& plan) {
  throw SceneError(Problem{"granules",
                           fmt::format("{} granules, solid fraction {:.3g}", plan.granules, plan.damper.fill_fraction),
                           "cannot be placed without overlaps", "fewer or smaller granules, or explicit positions"});
}

} // namespace

Placement place_granules(const Plan& plan, const std::function<void()>& pulse) {
  const Scene& scene = plan.scene;
  const Room room(scene.enclosure);
  Spheres spheres;
  std::vector<Name> names;
  Placement placement = lay_out(scene, spheres, names);
  check_explicit(room, spheres, names, placement);

  const bool by_count = std::any_of(spheres.placed.begin(), spheres.placed.end(), [](char placed) { return !placed; });
  if (by_count) {
    RandomNumbers random(scene.seed, 2);
    placement.to_be_poured = scene.packing == PackingKind::settled;
    // Too full for a loose lattice: random places can still be found. Too full for those: a close packing with gaps.
    const bool found = (placement.to_be_poured && packing::place_on_lattice(room, scene.gravity, spheres, random)) ||
                       packing::place_at_random(room, spheres, random, pulse) ||
                       packing::place_on_close_packing(room, spheres, random);
    if (!found) refuse(plan);
  }
  placement.position = std::move(spheres.position);
  return placement;
}

} // namespace grandamp
