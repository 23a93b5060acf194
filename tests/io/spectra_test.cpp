// Transforms and spectra against sums, closed forms and noise of known power.
#include "io/fourier.hpp"
#include "io/spectra.hpp"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <random>

using namespace grandamp;

namespace {

constexpr double pi = std::numbers::pi;

EvenRecord noise(std::size_t count, double interval, double gain, double own_noise, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  EvenRecord record;
  record.interval = interval;
  for (std::size_t n = 0; n < count; ++n) {
    record.force.push_back(normal(engine));
    record.displacement.push_back(gain * record.force.back() + own_noise * normal(engine));
  }
  return record;
}

} // namespace

TEST_CASE("the transform of a real record is the sum that defines it, for every length that is used") {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  for (const std::size_t length : {4, 8, 12, 20, 36, 60, 100, 180, 300}) {
    CAPTURE(length);
    CHECK(transform_length(length) == length);
    std::vector<double> values(length);
    for (double& value : values) value = normal(engine);
    const auto spectrum = half_spectrum(values);
    REQUIRE(spectrum.size() == length / 2 + 1);
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
      std::complex<double> sum = 0.0;
      for (std::size_t n = 0; n < length; ++n)
        sum +=
            values[n] * std::polar(1.0, -2.0 * pi * static_cast<double>(k * n % length) / static_cast<double>(length));
      CHECK(std::abs(spectrum[k] - sum) < 1e-12 * static_cast<double>(length));
    }
  }
}

TEST_CASE("lengths of transforms have small factors and are the next ones") {
  CHECK(transform_length(0) == 4);
  CHECK(transform_length(1) == 4);
  CHECK(transform_length(5) == 8);
  CHECK(transform_length(29) == 32);
  CHECK(transform_length(7001) == 7200);
  CHECK(transform_length(1'000'003) == 1'012'500);
}

TEST_CASE("a sine's power stands in its line, a noise's is spread at its density") {
  EvenRecord sine{0.01, {}, {}};
  for (int n = 0; n < 2000; ++n) {
    sine.force.push_back(3.0 * std::sin(2.0 * pi * 5.0 * 0.01 * n) + 7.0);
    sine.displacement.push_back(0.5 * std::cos(2.0 * pi * 5.0 * 0.01 * n));
  }
  for (const SpectralWindow window : {SpectralWindow::rectangular, SpectralWindow::hann}) {
    const Spectra found = estimate_spectra(sine, {400, 200, window}, 1.0, 20.0);
    CHECK(found.resolution == doctest::Approx(0.25));
    CHECK(found.segments == 9);
    double force = 0.0, displacement = 0.0;
    for (std::size_t k = 0; k < found.frequency.size(); ++k) {
      force += found.force[k] * found.resolution;
      displacement += found.displacement[k] * found.resolution;
    }
    CHECK(force == doctest::Approx(4.5));
    CHECK(displacement == doctest::Approx(0.125));
    const auto line = static_cast<std::size_t>(std::lround((5.0 - found.frequency[0]) / found.resolution));
    // x = cos is a quarter ahead of f = sin.
    CHECK(std::abs(found.response(line) - std::complex<double>(0.0, 0.5 / 3.0)) < 1e-12);
  }
  const Spectra white =
      estimate_spectra(noise(400'000, 0.01, 2.0, 0.0, 3), {400, 200, SpectralWindow::hann}, 0.5, 49.0);
  double mean = 0.0;
  for (const double density : white.force) mean += density / static_cast<double>(white.force.size());
  CHECK(mean == doctest::Approx(2.0 * 0.01).epsilon(0.01)); // variance 1 over 50 Hz
}

TEST_CASE("coherence is the share of power that the force explains, and H1 scatters as its random error says") {
  constexpr double gain = 2.0, own_noise = 1.0; // coherence 4 / 5
  for (const auto& [window, hop] : {std::pair{SpectralWindow::rectangular, 256}, {SpectralWindow::hann, 128}}) {
    const Spectra found = estimate_spectra(noise(256 * 60, 1.0, gain, own_noise, 11),
                                           {256, static_cast<std::size_t>(hop), window}, 0.01, 0.49);
    CHECK(found.segments == (hop == 256 ? 60 : 119));
    CHECK(found.averages == doctest::Approx(hop == 256 ? 60.0 : 119.0 / (1.0 + 2.0 / 36.0 * 118.0 / 119.0)));
    double coherence = 0.0, scatter = 0.0, said = 0.0;
    const auto lines = static_cast<double>(found.frequency.size());
    for (std::size_t k = 0; k < found.frequency.size(); ++k) {
      coherence += found.coherence(k) / lines;
      scatter += std::pow(std::abs(found.response(k)) / gain - 1.0, 2) / lines;
      said += std::pow(found.random_error(k), 2) / lines;
    }
    CHECK(coherence == doctest::Approx(0.8).epsilon(0.02));
    CHECK(std::sqrt(scatter) == doctest::Approx(std::sqrt(said)).epsilon(0.15));
    CHECK(std::sqrt(said) == doctest::Approx(std::sqrt(0.2 / (2.0 * found.averages * 0.8))).epsilon(0.1));
  }
}

TEST_CASE("the bias of a Hann window at a resonance is the mean of the resonance over the window's spectrum") {
  CHECK(hann_bias(0.3, 200.0) == doctest::Approx(-4.0 / 3.0 / (60.0 * 60.0)).epsilon(0.01));
  for (const double bandwidth : {0.05, 0.3, 1.0, 5.0}) {
    // The window's power spectrum by a sum of its samples, at 32 places per line.
    constexpr double segment = 4.0;
    constexpr int samples = 64, lines = 1024;
    double power = 0.0, seen = 0.0;
    for (int k = -lines; k <= lines; ++k) {
      const double f = k / (32.0 * segment);
      std::complex<double> sum = 0.0;
      for (int n = 0; n < samples; ++n)
        sum += (0.5 - 0.5 * std::cos(2.0 * pi * n / samples)) * std::polar(1.0, -2.0 * pi * f * segment * n / samples);
      if (std::abs(f * segment) > 0.5 * samples) continue; // its own mirror image
      power += std::norm(sum);
      seen += std::norm(sum) / (1.0 + std::pow(2.0 * f / bandwidth, 2));
    }
    CHECK(hann_bias(bandwidth, segment) == doctest::Approx(seen / power - 1.0).epsilon(0.02));
  }
}

TEST_CASE("one segment has a coherence of one by construction, and lines without displacement have none") {
  const Spectra one = estimate_spectra(noise(256, 1.0, 2.0, 5.0, 2), {256, 256, SpectralWindow::rectangular}, 0.1, 0.4);
  for (std::size_t k = 0; k < one.frequency.size(); ++k) CHECK(one.coherence(k) == doctest::Approx(1.0));
  const Spectra still =
      estimate_spectra(noise(512, 1.0, 0.0, 0.0, 2), {256, 256, SpectralWindow::rectangular}, 0.1, 0.4);
  for (std::size_t k = 0; k < still.frequency.size(); ++k) CHECK(still.coherence(k) == 0.0);
}
