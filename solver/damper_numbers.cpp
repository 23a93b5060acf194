#include "solver/damper_numbers.hpp"

#include "solver/excitation_signal.hpp"
#include "solver/measures.hpp"
#include "solver/several_modes.hpp"

#include <limits>

namespace grandamp {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
using std::numbers::pi;

/// At the rows of a table of motion, m/s^2.
double largest_acceleration(const Excitation& table) {
  const PiecewisePolynomial motion = make_motion(table);
  double largest = 0.0;
  for (const double time : table.times) largest = std::max(largest, std::abs(motion.at({time, 0.0}).acceleration));
  return largest;
}

/// Largest acceleration of the enclosure without granules, m/s^2: in the steady state where it is forced, else from
/// rest at its first displacement or at its first speed.
double bare_acceleration(const Scene& scene) {
  const double w = 2.0 * pi * scene.excitation.frequency;
  if (scene.excitation.kind == ExcitationKind::prescribed)
    return scene.excitation.velocity ? 0.0 : std::abs(scene.excitation.amplitude) * w * w;
  if (!scene.structure) return is_motion_table(scene.excitation) ? largest_acceleration(scene.excitation) : none;
  if (has_several_modes(scene)) return none; // no one formula
  const Structure& s = *scene.structure;
  if (scene.excitation.kind == ExcitationKind::none) {
    const double natural = std::sqrt(s.stiffness / s.mass);
    return natural * std::hypot(natural * s.displacement, s.velocity);
  }
  const bool sine = scene.excitation.kind == ExcitationKind::harmonic || scene.excitation.kind == ExcitationKind::base;
  if (!sine) return none; // no steady state
  const double impedance = std::hypot(s.stiffness - s.mass * w * w, s.damping * w);
  return impedance > 0.0 ? largest_force(scene) * w * w / impedance : none;
}

/// Along gravity, or else along the motion: what the bed leaves free of the enclosure, m.
double clearance(const Scene& scene, double fill_fraction) {
  Vector3 direction = scene.gravity;
  if (norm(direction) == 0.0) {
    if (scene.structure)
      direction = scene.structure->direction;
    else if (scene.excitation.kind == ExcitationKind::prescribed || is_motion_table(scene.excitation))
      direction = scene.excitation.direction;
    else
      return none;
  }
  const double length = norm(direction);
  for (double& component : direction) component /= length;
  return extent_along(scene.enclosure, direction) * std::max(0.0, 1.0 - fill_fraction / bed_solid_fraction);
}

} // namespace

DamperNumbers damper_numbers(const Scene& scene) {
  constexpr double standard_gravity = 9.80665;
  const double gravity = norm(scene.gravity);
  DamperNumbers numbers;
  numbers.granule_mass = granule_mass(scene);
  numbers.fill_fraction = solid_volume(scene) / volume_of(scene.enclosure);
  numbers.clearance = clearance(scene, numbers.fill_fraction);
  numbers.acceleration = bare_acceleration(scene) / (gravity > 0.0 ? gravity : standard_gravity);
  numbers.mass_ratio = numbers.natural_frequency = numbers.loaded_frequency = none;
  if (has_several_modes(scene)) {
    const ModalNumbers modal = modal_numbers(scene.structure->modes, numbers.granule_mass);
    numbers.mass_ratio = numbers.granule_mass / modal.enclosure_mass;
    numbers.natural_frequency = modal.frequency.front();
    numbers.loaded_frequency = modal.loaded_frequency;
  } else if (scene.structure) {
    const Structure& s = *scene.structure;
    numbers.mass_ratio = numbers.granule_mass / s.mass;
    if (s.stiffness > 0.0) {
      numbers.natural_frequency = std::sqrt(s.stiffness / s.mass) / (2.0 * pi);
      numbers.loaded_frequency = std::sqrt(s.stiffness / (s.mass + numbers.granule_mass)) / (2.0 * pi);
    }
  }
  return numbers;
}

} // namespace grandamp
