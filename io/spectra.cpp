#include "io/spectra.hpp"

#include "io/fourier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grandamp {
namespace {

std::vector<double> window_values(SpectralWindow window, std::size_t length) {
  std::vector<double> values(length, 1.0);
  const std::size_t taper = length / 10;
  for (std::size_t n = 0; n < length; ++n) {
    if (window == SpectralWindow::hann)
      values[n] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(length));
    else if (window == SpectralWindow::tapered_end && n + taper >= length)
      values[n] = 0.5 + 0.5 * std::cos(std::numbers::pi * static_cast<double>(n + taper + 1 - length) /
                                       static_cast<double>(taper + 1));
  }
  return values;
}

std::vector<std::complex<double>> transform(const std::vector<double>& values, std::size_t begin,
                                            const std::vector<double>& window) {
  std::vector<double> segment(window.size());
  double mean = 0.0;
  for (std::size_t n = 0; n < segment.size(); ++n) mean += values[begin + n];
  mean /= static_cast<double>(segment.size());
  for (std::size_t n = 0; n < segment.size(); ++n) segment[n] = window[n] * (values[begin + n] - mean);
  return half_spectrum(segment);
}

/// Welch's share of overlapping segments: their scatter is correlated by the window's overlap with itself, squared.
double independent(std::size_t segments, std::size_t hop, const std::vector<double>& window) {
  double own = 0.0, shared = 0.0;
  for (std::size_t n = 0; n < window.size(); ++n) {
    own += window[n] * window[n];
    if (n + hop < window.size()) shared += window[n] * window[n + hop];
  }
  const double count = static_cast<double>(segments), correlation = shared / own;
  return count / (1.0 + 2.0 * correlation * correlation * (count - 1.0) / count);
}

} // namespace

double Spectra::coherence(std::size_t line) const {
  const double product = force[line] * displacement[line];
  return product > 0.0 ? std::min(1.0, std::norm(cross[line]) / product) : 0.0;
}

double Spectra::random_error(std::size_t line) const {
  const double common = coherence(line);
  return std::sqrt((1.0 - common) / (2.0 * averages * common));
}

Spectra estimate_spectra(const EvenRecord& record, const Segmentation& segmentation, double low, double high) {
  const std::size_t length = segmentation.length;
  const std::vector<double> window = window_values(segmentation.window, length);
  double power = 0.0;
  for (const double value : window) power += value * value;

  Spectra spectra;
  const double duration = record.interval * static_cast<double>(length);
  spectra.resolution = 1.0 / duration;
  // Half the sampling rate itself is left out: its line would not be one-sided.
  const double end = std::min(std::floor(high * duration + 1e-6), 0.5 * static_cast<double>(length) - 1.0);
  const auto last = static_cast<std::size_t>(std::max(end, 0.0));
  const auto first = static_cast<std::size_t>(std::max(std::ceil(low * duration - 1e-6), 1.0));
  for (std::size_t k = first; k <= last; ++k) spectra.frequency.push_back(static_cast<double>(k) / duration);
  spectra.force.resize(spectra.frequency.size());
  spectra.displacement.resize(spectra.frequency.size());
  spectra.cross.resize(spectra.frequency.size());

  for (std::size_t begin = 0; begin + length <= record.force.size(); begin += segmentation.hop) {
    const auto force = transform(record.force, begin, window);
    const auto displacement = transform(record.displacement, begin, window);
    for (std::size_t k = 0; k < spectra.frequency.size(); ++k) {
      spectra.force[k] += std::norm(force[first + k]);
      spectra.displacement[k] += std::norm(displacement[first + k]);
      spectra.cross[k] += std::conj(force[first + k]) * displacement[first + k];
    }
    ++spectra.segments;
  }
  const double scale = 2.0 * record.interval / (power * static_cast<double>(spectra.segments));
  for (std::size_t k = 0; k < spectra.frequency.size(); ++k) {
    spectra.force[k] *= scale;
    spectra.displacement[k] *= scale;
    spectra.cross[k] *= scale;
  }
  spectra.averages = independent(spectra.segments, segmentation.hop, window);
  return spectra;
}

double hann_bias(double bandwidth, double segment) {
  using std::numbers::pi;
  const double decay = pi * bandwidth * segment;
  // What is missing of the correlation at a lag, a share u of the segment; without it the integral is 1 - exp(-decay).
  const auto missing = [](double u) {
    return 1.0 - (2.0 / 3.0 * (1.0 - u) * (1.0 + 0.5 * std::cos(2.0 * pi * u)) + std::sin(2.0 * pi * u) / (2.0 * pi));
  };
  constexpr int intervals = 2000; // Simpson's rule
  double sum = 0.0;
  for (int k = 0; k <= intervals; ++k) {
    const double u = static_cast<double>(k) / intervals;
    sum += (k == 0 || k == intervals ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) * decay * missing(u) * std::exp(-decay * u);
  }
  return -std::exp(-decay) - sum / (3.0 * intervals);
}

} // namespace grandamp
