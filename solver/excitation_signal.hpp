// What an excitation does as a function of time, where that is more than one sine.
#pragma once

#include "solver/piecewise_polynomial.hpp"
#include "solver/scene.hpp"

#include <limits>
#include <memory>

namespace grandamp {

/// A force by time, N: a function of the scene and the instant, of nothing else.
class ForceSignal {
public:
  virtual ~ForceSignal() = default;
  virtual double at(Instant instant) const = 0;
  /// The first instant after `time` at which the force or a derivative of it jumps, s; infinite: none.
  virtual double next_break(double /*time*/) const { return std::numeric_limits<double>::infinity(); }
};

/// Of a chirp, a random force, an impulse or a table of forces; null for other excitations. `duration`: what a chirp
/// without sweep_duration lasts, s.
std::unique_ptr<ForceSignal> make_force_signal(const Scene& scene);

/// The motion that a table of displacements or accelerations describes, m. Accelerations are integrated from rest at
/// x = 0 and t = 0.
PiecewisePolynomial make_motion(const Excitation& excitation);
/// Whether the excitation is a table of a motion.
bool is_motion_table(const Excitation& excitation) noexcept;

/// Largest force that the excitation may reach, N (random: what is exceeded once in some 10^5 of its periods).
double largest_force(const Scene& scene);
/// The highest frequency of a force that is no single sine, Hz; 0: none, or (an impulse, a table) none that a step
/// would have to be short for.
double highest_frequency(const Excitation& excitation) noexcept;

} // namespace grandamp
