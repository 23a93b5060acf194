// Records of an oscillator under a known force, for what reads frequency responses from them.
#pragma once

#include "io/even_record.hpp"
#include "io/frequency_response.hpp"

#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace grandamp::test {

struct LinearOscillator {
  double mass = 0.1, stiffness = 1000.0, damping = 0.2;

  std::complex<double> response(double frequency) const {
    const double w = 2.0 * std::numbers::pi * frequency;
    return 1.0 / std::complex<double>(stiffness - mass * w * w, damping * w);
  }
  double natural_frequency() const { return std::sqrt(stiffness / mass) / (2.0 * std::numbers::pi); }
  double bandwidth() const { return damping / (2.0 * std::numbers::pi * mass); }

  /// From rest; the force a straight line between two times: the exact solution, in complex modal coordinates.
  ResponseHistory record(const std::vector<double>& time, const std::function<double(double)>& force) const {
    using Complex = std::complex<double>;
    const Complex root(-0.5 * damping / mass, std::sqrt(stiffness / mass - 0.25 * damping * damping / (mass * mass)));
    const Complex gain = 1.0 / (mass * (root - std::conj(root)));
    ResponseHistory rows;
    rows.time = time;
    Complex state = 0.0;
    double before = 0.0;
    for (std::size_t n = 0; n < time.size(); ++n) {
      const double now = force(time[n]);
      if (n > 0) {
        const double h = time[n] - time[n - 1];
        const Complex a = root * h, once = (std::exp(a) - 1.0) / a, twice = (std::exp(a) - 1.0 - a) / (a * a);
        state = std::exp(a) * state + gain * h * (before * (once - twice) + now * twice);
      }
      before = now;
      rows.displacement.push_back(2.0 * state.real());
      rows.velocity.push_back(2.0 * (root * state).real());
      rows.force.push_back(now);
    }
    return rows;
  }

  LinearHost host(double added_mass = 0.0) const {
    LinearHost host;
    host.bare = [*this](double frequency) { return response(frequency); };
    LinearOscillator heavier = *this;
    heavier.mass += added_mass;
    host.added_mass = [heavier](double frequency) { return heavier.response(frequency); };
    host.decay_rate = 0.5 * damping / heavier.mass;
    host.bandwidth = bandwidth();
    return host;
  }
};

inline std::vector<double> even_times(double duration, double interval) {
  std::vector<double> times;
  for (std::int64_t n = 0; n <= std::llround(duration / interval); ++n)
    times.push_back(static_cast<double>(n) * interval);
  return times;
}

/// Sines of one amplitude and phases at random, on the multiples of 1/period in the band.
inline std::function<double(double)> periodic_force(double low, double high, double period, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  std::vector<double> w, phases;
  for (double k = std::ceil(low * period); k <= high * period; ++k) {
    w.push_back(2.0 * std::numbers::pi * k / period);
    phases.push_back(phase(engine));
  }
  return [w, phases](double t) {
    double sum = 0.0;
    for (std::size_t k = 0; k < w.size(); ++k) sum += std::sin(w[k] * t + phases[k]);
    return sum;
  };
}

/// Every value independent of all others; to be asked in the order of time.
inline std::function<double(double)> white_force(unsigned seed) {
  return [engine = std::mt19937_64(seed), normal = std::normal_distribution<double>()](double) mutable {
    return normal(engine);
  };
}

/// A sine whose frequency goes evenly from `low` to `high` in `duration`, again and again.
inline std::function<double(double)> chirp_force(double low, double high, double duration) {
  return [=](double t) {
    const double s = std::fmod(t, duration);
    return std::sin(2.0 * std::numbers::pi * (low * s + 0.5 * (high - low) / duration * s * s));
  };
}

/// The largest |H / closed form - 1| of the lines whose closed form reaches `share` of the largest.
inline double largest_error(const FrequencyResponse& found, const LinearOscillator& oscillator, double share = 0.5) {
  double top = 0.0, error = 0.0;
  for (const double f : found.spectra.frequency) top = std::max(top, std::abs(oscillator.response(f)));
  for (std::size_t k = 0; k < found.response.size(); ++k) {
    const std::complex<double> exact = oscillator.response(found.spectra.frequency[k]);
    if (std::abs(exact) >= share * top) error = std::max(error, std::abs(found.response[k] / exact - 1.0));
  }
  return error;
}

} // namespace grandamp::test
