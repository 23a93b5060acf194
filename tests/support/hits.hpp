// Hits at every angle, side by side in one scene; and the losses that they are tried with.
#pragma once

#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace grandamp::test {

inline void put_on_springs(Scene& scene, double share = 0.9, double damping = 0.0) {
  scene.contact.friction = FrictionLaw::spring;
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    constants->tangential_stiffness = share * *constants->stiffness;
    constants->tangential_damping = damping;
  }
}

inline void set_losses(Scene& scene, double restitution, double friction) {
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    constants->alpha.reset();
    constants->restitution = restitution;
    constants->friction = friction;
  }
}

/// Hits at 90 angles from head-on to grazing, side by side in one scene: the first granule of each against another one
/// `ratio` times as large, or against the floor (ratio 0). A third of them spin.
struct Hits {
  static constexpr int angles = 90;
  static constexpr double radius = 1.5e-3;
  Scene scene;
  double effective_mass = 0.0;

  /// `speed` in m/s; `steps` in a contact at that speed; `phase`: how much of a step passes before they touch.
  Hits(double ratio, double restitution, double friction, double speed = 2.0, double steps = 8.0, double phase = 0.0)
      : scene(box_scene(1.0, radius)) {
    set_losses(scene, restitution, friction);
    const double other = ratio * radius, pitch = 4.0 * (radius + other) + 2.0e-3;
    Population& all = scene.populations[0];
    const double mass = sphere_mass(radius), other_mass = sphere_mass(other);
    const double reduced = ratio > 0.0 ? radius * other / (radius + other) : radius;
    effective_mass = ratio > 0.0 ? mass * other_mass / (mass + other_mass) : mass;
    const double stiffness =
        ratio > 0.0 ? 1.0e7 * std::sqrt(2.0 * reduced / 3.0e-3) : 1.3e7 * std::sqrt(reduced / 3.0e-3);
    const double lasts = contact_duration(effective_mass, stiffness, speed), step = lasts / steps;
    for (int n = 0; n < angles; ++n) {
      const double angle = n * std::numbers::pi / 180.0;
      const double gap = 1.0e-9 * (1 + n % 7) + phase * speed * step * std::cos(angle);
      const double x = pitch * (n % 10 + 1), y = pitch * (n / 10 + 1);
      const double z = ratio > 0.0 ? 0.5 : radius + gap;
      const double turn = n % 3 == 2 ? 800.0 : 0.0;
      add_granule(scene, {x, y, z}, {speed * std::sin(angle), 0.0, -speed * std::cos(angle)},
                  {0.3 * turn, -turn, turn});
      all.radii.push_back(radius);
      all.masses.push_back(mass);
      if (ratio == 0.0) continue;
      add_granule(scene, {x, y, z - radius - other - gap});
      all.radii.push_back(other);
      all.masses.push_back(other_mass);
    }
    scene.time.impact_speed = speed;
    scene.time.duration = 6.0 * lasts + step; // at 89 degrees the closing speed is a sixtieth: 2.3 times as long
    use_step(scene, step);
  }
};

/// Kinetic energy of each hit.
inline std::vector<double> energies(const Hits& hits, const GranuleTable& now) {
  const Population& all = hits.scene.populations[0];
  std::vector<double> sum(Hits::angles, 0.0);
  const std::size_t each = now.position.size() / Hits::angles;
  for (std::size_t i = 0; i < now.position.size(); ++i)
    sum[i / each] += 0.5 * all.masses[i] * dot(now.velocity[i], now.velocity[i]) +
                     0.2 * all.masses[i] * all.radii[i] * all.radii[i] * dot(now.spin[i], now.spin[i]);
  return sum;
}

} // namespace grandamp::test
