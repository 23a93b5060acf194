#include "solver/impact_speed.hpp"

#include "solver/enclosure_motion.hpp"
#include "solver/excitation_signal.hpp"
#include "solver/measures.hpp"
#include "solver/several_modes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace grandamp {

namespace {

using std::numbers::pi;
constexpr double least = 0.01; // m/s

/// Largest speed of the enclosure without granules over the run, and largest change from its first one, m/s.
struct EnclosureSpeed {
  double largest = 0.0;
  double largest_change = 0.0;
};

/// Bound on the bare structure's velocity after `time`: the steady amplitude and what is left of the transient, or
/// (resonance without damping) what the force can have given at most.
double velocity_bound_after(const Scene& scene, double time) {
  const Structure& s = *scene.structure;
  const double force = driving_force(scene);
  const double w = 2.0 * pi * scene.excitation.frequency;
  const double in_phase = s.stiffness - s.mass * w * w, out_of_phase = s.damping * w;
  const double square = in_phase * in_phase + out_of_phase * out_of_phase;
  const double natural = std::sqrt(s.stiffness / s.mass);
  const double at_most =
      std::hypot(s.velocity, natural * s.displacement) + std::abs(force) / s.mass * scene.time.duration;
  if (!(square > 0.0)) return at_most;
  // x = a sin w t + b cos w t in the steady state; the rest of the first energy is the transient's.
  const double a = force * in_phase / square, b = -force * out_of_phase / square;
  const double transient = std::hypot(s.velocity - a * w, natural * (s.displacement - b));
  const double decay = s.damping / (2.0 * s.mass);
  const double left = decay < natural ? std::exp(-decay * time) : 1.0;
  return std::min(at_most, std::hypot(a, b) * w + left * transient);
}

/// The same for what is no harmonic force: the steady amplitude at resonance, F / c, or what the force can have given.
double velocity_bound_at_resonance(const Scene& scene) {
  const Structure& s = *scene.structure;
  const double force = largest_force(scene);
  const double first = std::hypot(s.velocity, std::sqrt(s.stiffness / s.mass) * s.displacement);
  const double given = force / s.mass * scene.time.duration;
  return first + (s.damping > 0.0 ? std::min(given, force / s.damping) : given);
}

/// Highest rate at which the enclosure's motion may change, Hz.
double rate_of_motion(const Scene& scene) {
  const Excitation& e = scene.excitation;
  double rate = e.kind == ExcitationKind::none ? 0.0 : std::max(e.frequency, highest_frequency(e));
  if (e.kind == ExcitationKind::impulse) rate = 0.5 / e.pulse_duration;
  if (is_motion_table(e)) // four rows make a wave
    for (std::size_t k = 0; k + 1 < e.times.size(); ++k) rate = std::max(rate, 0.25 / (e.times[k + 1] - e.times[k]));
  if (scene.structure) {
    const Oscillator fastest = fastest_oscillator(*scene.structure);
    rate = std::max(rate, std::sqrt(fastest.stiffness / fastest.mass) / (2.0 * pi));
    rate = std::max(rate, fastest.damping / (4.0 * fastest.mass));
  }
  return rate;
}

/// The exact solution, looked at 64 times a period: no formula for transient, beat or overdamping is needed. A very
/// long run is looked at over its first 4096 periods, and bounded from there on; a chirp, an impulse or a table, whose
/// best is yet to come, over 16 times as many.
EnclosureSpeed bare_enclosure_speed(const Scene& scene) {
  const ExcitationKind kind = scene.excitation.kind;
  const double rate = rate_of_motion(scene);
  const bool comes_later =
      kind == ExcitationKind::chirp || kind == ExcitationKind::impulse || kind == ExcitationKind::table;
  const double periods = comes_later ? 65536.0 : 4096.0;
  const double looked_at = rate > 0.0 ? std::min(scene.time.duration, periods / rate) : scene.time.duration;
  const double looks = std::max(64.0, std::ceil(64.0 * rate * looked_at));
  const EnclosureMotion motion(scene, looked_at / looks);
  EnclosureState state = motion.start(0.0);
  EnclosureSpeed speed{std::abs(motion.initial_velocity()), 0.0};
  if (motion.has_several_modes()) { // looked at as long as a run of one mode is, and not beyond
    const Vector3 first = motion.velocity_of(motion.initial_state());
    speed.largest = norm(first);
    for (std::int64_t n = 0; n <= static_cast<std::int64_t>(looks); ++n) {
      const Vector3 v = motion.advance(state, n, 0.0).mean_velocity;
      speed.largest = std::max(speed.largest, norm(v));
      speed.largest_change = std::max(speed.largest_change, norm({v[0] - first[0], v[1] - first[1], v[2] - first[2]}));
    }
    return speed;
  }
  for (std::int64_t n = 0; n <= static_cast<std::int64_t>(looks); ++n) {
    const double velocity = motion.advance(state, n, 0.0).velocity;
    speed.largest = std::max(speed.largest, std::abs(velocity));
    speed.largest_change = std::max(speed.largest_change, std::abs(velocity - motion.initial_velocity()));
  }
  if (scene.structure && looked_at < scene.time.duration) {
    const bool sine = kind == ExcitationKind::none || kind == ExcitationKind::harmonic;
    const double later = sine ? velocity_bound_after(scene, looked_at) : velocity_bound_at_resonance(scene);
    speed.largest = std::max(speed.largest, later);
    speed.largest_change = std::max(speed.largest_change, later + std::abs(motion.initial_velocity()));
  }
  return speed;
}

/// Largest speeds of granules at t = 0, in the laboratory and relative to the enclosure, m/s.
struct FirstSpeed {
  double laboratory = 0.0;
  double relative = 0.0;
};

FirstSpeed first_speed(const Scene& scene) {
  const EnclosureMotion motion(scene, 1.0); // only for how the enclosure starts
  const Vector3 enclosure = motion.velocity_of(motion.initial_state());
  FirstSpeed speed;
  for (const Population& population : scene.populations) {
    if (population.count == 0) continue;
    if (population.velocities.empty()) {
      speed.laboratory = std::max(speed.laboratory, population.speed);
      speed.relative = std::max(speed.relative, population.speed + norm(enclosure));
    }
    for (const Vector3& v : population.velocities) {
      const Vector3 relative{v[0] - enclosure[0], v[1] - enclosure[1], v[2] - enclosure[2]};
      speed.laboratory = std::max(speed.laboratory, norm(v));
      speed.relative = std::max(speed.relative, norm(relative));
    }
  }
  return speed;
}

/// How far a granule may fall, m: the enclosure's extent along gravity less a poured bed, a diameter at least.
double free_height(const Scene& scene) {
  const double gravity = norm(scene.gravity);
  const Vector3 down{scene.gravity[0] / gravity, scene.gravity[1] / gravity, scene.gravity[2] / gravity};
  const double bed = solid_volume(scene) / (bed_solid_fraction * volume_of(scene.enclosure));
  return std::max(2.0 * radius_range(scene).largest, extent_along(scene.enclosure, down) * (1.0 - std::min(1.0, bed)));
}

} // namespace

ImpactSpeed estimate_impact_speed(const Scene& scene) {
  const EnclosureSpeed enclosure = bare_enclosure_speed(scene);
  const FirstSpeed granules = first_speed(scene);
  // Two granules may meet head on, each as fast as the fastest; and a wall that moves at w throws a granule at up to 2
  // w. Seen from the laboratory or from the enclosure at its start, whichever shows less: a common motion is no impact.
  const double laboratory = granules.laboratory + enclosure.largest;
  const double relative = granules.relative + enclosure.largest_change;
  const double thrown = 2.0 * std::min(laboratory, relative);
  const bool by_laboratory = laboratory <= relative;
  const double first = by_laboratory ? granules.laboratory : granules.relative;
  const double moved = by_laboratory ? enclosure.largest : enclosure.largest_change;
  std::string reason = fmt::format("estimated: twice the bare enclosure's {:.3g} m/s", moved);
  if (first > 0.0 && moved > 0.0)
    reason += fmt::format(" and the granules' first {:.3g} m/s", first);
  else if (first > 0.0)
    reason = fmt::format("estimated: twice the granules' first {:.3g} m/s", first);
  // What falls gains the square of its speed.
  const double gravity = norm(scene.gravity);
  const double fall = gravity > 0.0 ? std::sqrt(2.0 * gravity * free_height(scene)) : 0.0;
  if (fall > 0.0) reason += fmt::format(", with a fall's {:.3g} m/s", fall);
  const double speed = std::hypot(thrown, fall);
  if (speed >= least) return {speed, reason};
  return {least, "next to nothing in the scene moves: the least taken"};
}

} // namespace grandamp
