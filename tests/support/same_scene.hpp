// Whether two scenes are the same, value by value and bit by bit (no value of a read scene is NaN or -0 by accident).
#pragma once

#include "solver/scene.hpp"

#include <tuple>

namespace grandamp::test {

inline auto values(const Enclosure& e) {
  return std::tie(e.shape, e.size, e.diameter, e.height, e.axis);
}
inline auto values(const Population& p) {
  return std::tie(p.name, p.count, p.radius, p.mass, p.young, p.poisson, p.speed, p.placed, p.positions, p.velocities,
                  p.spins, p.radii, p.masses);
}
inline auto values(const ContactConstants& c) {
  return std::tie(c.stiffness, c.reference_radius, c.restitution, c.alpha, c.normal_damping, c.friction,
                  c.tangential_stiffness, c.tangential_damping, c.young, c.poisson);
}
inline auto values(const Structure& s) {
  return std::tie(s.mass, s.stiffness, s.damping, s.direction, s.displacement, s.velocity, s.modes.size, s.modes.mass,
                  s.modes.damping, s.modes.stiffness, s.modes.attachment, s.modes.force, s.modes.displacement,
                  s.modes.velocity);
}
inline auto values(const Excitation& e) {
  return std::tie(e.kind, e.static_deflection, e.force, e.frequency, e.amplitude, e.acceleration, e.velocity,
                  e.direction, e.start_frequency, e.end_frequency, e.sweep, e.sweep_duration, e.force_rms, e.band,
                  e.period, e.seed, e.start, e.pulse_duration, e.quantity, e.interpolation, e.times, e.values);
}
inline auto values(const TimeControl& t) {
  return std::tie(t.duration, t.steps_per_contact, t.step, t.impact_speed, t.integrator);
}
inline auto values(const VerletControl& v) {
  return std::tie(v.policy, v.skin, v.cell, v.safety, v.max_interval, v.interval, v.audit);
}
inline auto values(const OutputControl& o) {
  return std::tie(o.history_interval, o.snapshot_interval, o.checkpoint_interval, o.window, o.energy);
}

template <class Table> bool same(const Table& a, const Table& b) {
  return values(a) == values(b);
}
template <class Table> bool same(const std::optional<Table>& a, const std::optional<Table>& b) {
  return a.has_value() == b.has_value() && (!a || values(*a) == values(*b));
}

inline bool same_scene(const Scene& a, const Scene& b) {
  if (a.populations.size() != b.populations.size()) return false;
  for (std::size_t i = 0; i < a.populations.size(); ++i)
    if (!same(a.populations[i], b.populations[i])) return false;
  if (a.contact.pairs.size() != b.contact.pairs.size()) return false;
  for (std::size_t i = 0; i < a.contact.pairs.size(); ++i)
    if (a.contact.pairs[i].between != b.contact.pairs[i].between ||
        !same(a.contact.pairs[i].constants, b.contact.pairs[i].constants))
      return false;
  return std::tie(a.title, a.seed, a.gravity, a.packing, a.contact.damping, a.contact.friction, a.contact.rotation,
                  a.contact.tension) == std::tie(b.title, b.seed, b.gravity, b.packing, b.contact.damping,
                                                 b.contact.friction, b.contact.rotation, b.contact.tension) &&
         same(a.enclosure, b.enclosure) && same(a.contact.granule, b.contact.granule) &&
         same(a.contact.wall, b.contact.wall) && same(a.structure, b.structure) && same(a.excitation, b.excitation) &&
         same(a.time, b.time) && same(a.verlet, b.verlet) && same(a.output, b.output);
}

} // namespace grandamp::test
