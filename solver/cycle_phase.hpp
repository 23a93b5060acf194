// The phase of a sine that keeps its digits after any number of steps.
#pragma once

#include <cmath>
#include <numbers>

namespace grandamp {

struct CyclePhase {
  double sine;
  double cosine;
};

/// Of 2 pi times cycles_per_step times `steps`. The product is formed with its rounding error, and whole cycles are
/// dropped before the angle is taken: as good after 10^9 cycles as in the first.
inline CyclePhase phase_at(double cycles_per_step, double steps) {
  const double product = cycles_per_step * steps;
  const double error = std::fma(cycles_per_step, steps, -product);
  const double angle = 2.0 * std::numbers::pi * ((product - std::floor(product)) + error);
  return {std::sin(angle), std::cos(angle)};
}

} // namespace grandamp
