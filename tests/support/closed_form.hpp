// The bare structure's motion in closed form.
#pragma once

#include "solver/scene.hpp"

#include <complex>
#include <numbers>

namespace grandamp::test {

using Complex = std::complex<double>;

/// x(t) of M x'' + c x' + K x = F sin(w t) by complex exponentials; K > 0 and not at an undamped resonance.
struct ClosedForm {
  Complex root_a, root_b, part_a, part_b, forced;
  double forcing = 0.0;

  ClosedForm(const Structure& s, double force, double frequency) : forcing(2.0 * std::numbers::pi * frequency) {
    const Complex under = std::sqrt(Complex(s.damping * s.damping - 4.0 * s.mass * s.stiffness));
    root_a = (-s.damping + under) / (2.0 * s.mass);
    root_b = (-s.damping - under) / (2.0 * s.mass);
    forced = force == 0.0 ? 0.0 : force / Complex(s.stiffness - s.mass * forcing * forcing, s.damping * forcing);
    // The forced part is Im(forced e^(i w t)).
    const double rest = s.displacement - forced.imag();
    const double rest_velocity = s.velocity - (Complex(0.0, forcing) * forced).imag();
    part_a = (rest_velocity - root_b * rest) / (root_a - root_b);
    part_b = rest - part_a;
  }
  double displacement(double t) const {
    return (part_a * std::exp(root_a * t) + part_b * std::exp(root_b * t)).real() +
           (forced * std::exp(Complex(0.0, forcing * t))).imag();
  }
  double velocity(double t) const {
    return (part_a * root_a * std::exp(root_a * t) + part_b * root_b * std::exp(root_b * t)).real() +
           (Complex(0.0, forcing) * forced * std::exp(Complex(0.0, forcing * t))).imag();
  }
};

} // namespace grandamp::test
