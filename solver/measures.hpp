// Simple sums over a scene: how many granules, how much volume, how long an enclosure is in some direction.
#pragma once

#include "solver/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grandamp {

inline double norm(const Vector3& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

inline double radius_of(const Population& population, std::size_t i) {
  return population.radii.empty() ? population.radius : population.radii[i];
}

inline double mass_of(const Population& population, std::size_t i) {
  return population.masses.empty() ? population.mass : population.masses[i];
}

inline double sphere_volume(double radius) {
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

inline std::size_t granule_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Population& population : scene.populations) count += population.count;
  return count;
}

/// Whether the packing has granules to place: such as are given by count.
inline bool any_by_count(const Scene& scene) {
  return std::any_of(scene.populations.begin(), scene.populations.end(),
                     [](const Population& population) { return population.count > 0 && !population.placed; });
}

/// Of all granules, m^3.
inline double solid_volume(const Scene& scene) {
  double volume = 0.0;
  for (const Population& population : scene.populations) {
    volume += population.radii.empty() ? static_cast<double>(population.count) * sphere_volume(population.radius) : 0.0;
    for (const double radius : population.radii) volume += sphere_volume(radius);
  }
  return volume;
}

/// Of all granules, kg.
inline double granule_mass(const Scene& scene) {
  double total = 0.0;
  for (const Population& population : scene.populations) {
    total += population.masses.empty() ? static_cast<double>(population.count) * population.mass : 0.0;
    for (const double mass : population.masses) total += mass;
  }
  return total;
}

struct RadiusRange {
  double smallest = 0.0; ///< m; both 0 without granules
  double largest = 0.0;  ///< m
};

inline RadiusRange radius_range(const Scene& scene) {
  RadiusRange range;
  for (const Population& population : scene.populations)
    for (std::size_t i = 0;
         i < (population.radii.empty() ? std::min<std::size_t>(1, population.count) : population.count); ++i) {
      const double radius = radius_of(population, i);
      range.smallest = range.smallest == 0.0 ? radius : std::min(range.smallest, radius);
      range.largest = std::max(range.largest, radius);
    }
  return range;
}

/// Inner volume, m^3.
inline double volume_of(const Enclosure& enclosure) {
  if (enclosure.shape == EnclosureShape::box) return enclosure.size[0] * enclosure.size[1] * enclosure.size[2];
  return 0.25 * std::numbers::pi * enclosure.diameter * enclosure.diameter * enclosure.height;
}

/// The box around the enclosure, from the origin, m.
inline Vector3 bounding_box(const Enclosure& enclosure) {
  if (enclosure.shape == EnclosureShape::box) return enclosure.size;
  Vector3 box{enclosure.diameter, enclosure.diameter, enclosure.diameter};
  box[static_cast<std::size_t>(enclosure.axis)] = enclosure.height;
  return box;
}

/// How far the enclosure reaches along a unit vector, m.
inline double extent_along(const Enclosure& enclosure, const Vector3& direction) {
  if (enclosure.shape == EnclosureShape::box)
    return enclosure.size[0] * std::abs(direction[0]) + enclosure.size[1] * std::abs(direction[1]) +
           enclosure.size[2] * std::abs(direction[2]);
  const double axial = std::abs(direction[static_cast<std::size_t>(enclosure.axis)]);
  return enclosure.height * axial + enclosure.diameter * std::sqrt(std::max(0.0, 1.0 - axial * axial));
}

/// Amplitude of a harmonic force, a chirp or an impulse, N; 0 without one.
inline double driving_force(const Scene& scene) {
  const Excitation& e = scene.excitation;
  const bool drives =
      e.kind == ExcitationKind::harmonic || e.kind == ExcitationKind::chirp || e.kind == ExcitationKind::impulse;
  if (!drives || !scene.structure) return 0.0;
  return e.force.value_or(scene.structure->stiffness * e.static_deflection.value_or(0.0));
}

/// Amplitude of the foundation's sine, m; 0 without one.
inline double base_amplitude(const Scene& scene) {
  const Excitation& e = scene.excitation;
  if (e.kind != ExcitationKind::base) return 0.0;
  const double w = 2.0 * std::numbers::pi * e.frequency;
  return e.acceleration ? *e.acceleration / (w * w) : e.amplitude;
}

/// Amplitude of the force K y + c y' that the moving foundation exerts on a structure held still, N.
inline double base_force(const Scene& scene) {
  if (!scene.structure) return 0.0;
  const double w = 2.0 * std::numbers::pi * scene.excitation.frequency;
  return std::abs(base_amplitude(scene)) * std::hypot(scene.structure->stiffness, scene.structure->damping * w);
}

/// Solid fraction that a poured bed is reckoned at.
inline constexpr double bed_solid_fraction = 0.6;

} // namespace grandamp
