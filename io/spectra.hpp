// Auto and cross spectra of force and displacement, averaged over segments of a record (Welch), and what follows from
// them: the frequency response by H1, the coherence, the random error.
#pragma once

#include "io/even_record.hpp"

#include <complex>
#include <cstddef>
#include <vector>

namespace grandamp {

enum class SpectralWindow {
  rectangular,
  hann,
  tapered_end, ///< one, and half a cosine down to zero over the last tenth: for a record that begins at rest
};

struct Segmentation {
  std::size_t length = 0; ///< samples
  std::size_t hop = 0;    ///< samples from the start of one to that of the next; no less than half the length
  SpectralWindow window = SpectralWindow::hann;
};

/// Spectral densities are one-sided: their sum over all lines times the resolution is the mean square.
struct Spectra {
  double resolution = 0.0;          ///< Hz between lines
  std::size_t segments = 0;         ///< averaged
  double averages = 0.0;            ///< as many independent segments scatter as much
  std::vector<double> frequency;    ///< Hz
  std::vector<double> force;        ///< S_ff, N^2/Hz
  std::vector<double> displacement; ///< S_xx, m^2/Hz
  std::vector<std::complex<double>>
      cross; ///< S_fx, N m/Hz: conjugate of the force's transform, times the displacement's

  /// H1 = S_fx / S_ff, m/N: noise in the displacement that has nothing to do with the force averages out.
  std::complex<double> response(std::size_t line) const { return cross[line] / force[line]; }
  /// |S_fx|^2 / (S_ff S_xx); 1 by construction with one segment.
  double coherence(std::size_t line) const;
  /// Standard error of |H1| over |H1|: sqrt((1 - coherence) / (2 averages coherence)) (Bendat and Piersol, Random
  /// Data).
  double random_error(std::size_t line) const;
};

/// Of the lines between `low` and `high`, Hz. The mean of each segment is left out. The record holds at least one
/// segment.
Spectra estimate_spectra(const EvenRecord& record, const Segmentation& segmentation, double low, double high);

/// By how much H1 of a Hann window is too low at the top of a resonance, over it: the mean of 1/(1 + 2 i f/B) over the
/// window's power spectrum, in lags: 1 - pi B int_0^T rho(t) exp(-pi B t) dt, rho being the window's correlation with
/// itself. For long segments -4/3 (B T)^-2. bandwidth B: at half power, Hz; segment T, s.
double hann_bias(double bandwidth, double segment);

} // namespace grandamp
