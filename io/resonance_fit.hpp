// One mode through the top of a measured frequency response.
#pragma once

#include <complex>
#include <vector>

namespace grandamp {

/// 1 / (stiffness - mass w^2 + i damping w), and what follows from it.
struct ResonanceFit {
  double mass = 0.0;              ///< kg
  double stiffness = 0.0;         ///< N/m
  double damping = 0.0;           ///< N s/m
  double natural_frequency = 0.0; ///< undamped, Hz
  double damping_ratio = 0.0;     ///< of critical
  double peak_frequency = 0.0;    ///< of the largest displacement, Hz; 0 if there is none (damping ratio above 0.707)
  double peak_magnitude = 0.0;    ///< there, m/N
  std::size_t lines = 0;          ///< that were fitted
  bool found = false;             ///< the numbers above are those of an oscillator

  /// Width of the peak at half its power, Hz.
  double bandwidth() const { return 2.0 * damping_ratio * natural_frequency; }
};

/// Least squares of response * (k - m w^2 + i c w) - 1 over the lines around the largest that reach half of it, and no
/// fewer than five. frequency in Hz, response in m/N.
ResonanceFit fit_resonance(const std::vector<double>& frequency, const std::vector<std::complex<double>>& response);

} // namespace grandamp
