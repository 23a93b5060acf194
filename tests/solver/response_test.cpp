// Statistics of the displacement: known signals with known amplitudes.
#include "solver/response.hpp"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace grandamp;

namespace {

constexpr double pi = std::numbers::pi;

/// x(t) and v(t) fed at every step of [0, 7 s], the window being the last half.
template <class Signal> ResponseStatistics statistics(Signal&& signal, double period, double dt = 1.0e-4) {
  ResponseAccumulator response({3.5, 7.0}, period, dt);
  for (std::int64_t n = 0; n <= std::llround(7.0 / dt); ++n) {
    const auto [x, v] = signal(static_cast<double>(n) * dt);
    response.add(n, x, v);
  }
  return response.result();
}

auto sine(double amplitude, double frequency, double phase = 0.3, double offset = 0.0) {
  return [=](double t) {
    const double angle = 2.0 * pi * frequency * t + phase;
    return std::pair{offset + amplitude * std::sin(angle), amplitude * 2.0 * pi * frequency * std::cos(angle)};
  };
}

} // namespace

TEST_CASE("a steady sine - rms and peak and amplitude in whole periods") {
  const double frequency = 15.91;
  const ResponseStatistics r = statistics(sine(0.02, frequency), 1.0 / frequency);
  CHECK(r.cycle_amplitudes.size() == static_cast<std::size_t>(std::floor(3.5 * frequency)));
  CHECK(r.amplitude == doctest::Approx(0.02).epsilon(1e-7));
  CHECK(r.peak_displacement == doctest::Approx(0.02).epsilon(1e-4));
  CHECK(r.rms_displacement == doctest::Approx(0.02 / std::sqrt(2.0)).epsilon(5e-3));
  CHECK(r.steady);
}

TEST_CASE("whole periods that fill the window exactly all count") {
  const ResponseStatistics r = statistics(sine(0.5, 2.0), 0.5);
  CHECK(r.cycle_amplitudes.size() == 7);
  CHECK(r.rms_displacement == doctest::Approx(0.5 / std::sqrt(2.0)).epsilon(1e-4));
  const ResponseStatistics rough = statistics(sine(0.5, 2.0), 0.5, 0.01);
  CHECK(rough.cycle_amplitudes.size() == 7);
  CHECK(rough.amplitude == doctest::Approx(0.5).epsilon(1e-4)); // 50 steps a period, turning points between them
}

TEST_CASE("rms is about zero and amplitude is not") {
  const ResponseStatistics r = statistics(sine(0.01, 10.0, 0.0, -0.05), 0.1);
  CHECK(r.rms_displacement == doctest::Approx(std::sqrt(0.05 * 0.05 + 0.5e-4)).epsilon(1e-4));
  CHECK(r.amplitude == doctest::Approx(0.01).epsilon(1e-6));
  CHECK(r.peak_displacement == doctest::Approx(0.06).epsilon(1e-4));
}

TEST_CASE("a growing amplitude is not steady and a scattered one without trend is") {
  const auto growing = [](double t) {
    const double w = 20.0 * pi;
    return std::pair{t * std::sin(w * t), std::sin(w * t) + t * w * std::cos(w * t)};
  };
  CHECK_FALSE(statistics(growing, 0.1).steady);
  const auto beating = [](double t) {
    const double w = 20.0 * pi, b = 1.0 + 0.1 * std::sin(pi * 4.0 * t);
    return std::pair{b * std::sin(w * t),
                     0.4 * pi * std::cos(pi * 4.0 * t) * std::sin(w * t) + b * w * std::cos(w * t)};
  };
  const ResponseStatistics r = statistics(beating, 0.1);
  CHECK(r.steady);
  CHECK(r.amplitude == doctest::Approx(1.0).epsilon(0.01));
}

TEST_CASE("free decay about an offset - a cycle per period and wiggles left aside") {
  const double w = 2.0 * pi * 5.0, decay = 0.8;
  const auto signal = [&](double t) {
    const double e = std::exp(-decay * t), wiggle = 2.0e-5 * std::sin(2.0e3 * t);
    return std::pair{-0.03 + e * std::cos(w * t) + wiggle,
                     e * (-decay * std::cos(w * t) - w * std::sin(w * t)) + 0.04 * std::cos(2.0e3 * t)};
  };
  const ResponseStatistics r = statistics(signal, 0.0);
  CHECK(r.cycle_amplitudes.size() >= 16);
  CHECK(r.cycle_amplitudes.size() <= 17);
  for (std::size_t k = 1; k < r.cycle_amplitudes.size(); ++k)
    CHECK(r.cycle_amplitudes[k] / r.cycle_amplitudes[k - 1] == doctest::Approx(std::exp(-decay / 5.0)).epsilon(0.01));
  CHECK_FALSE(r.steady);
}

TEST_CASE("a copy goes on as the original does and what is restored too") {
  ResponseAccumulator response({0.0, 1.0}, 0.1, 1.0e-3), other({0.0, 1.0}, 0.1, 1.0e-3);
  const auto signal = sine(1.0, 10.0);
  for (int n = 0; n <= 1000; ++n) {
    if (n == 437) other.restore(response.state());
    const auto [x, v] = signal(1.0e-3 * n);
    response.add(n, x, v);
    if (n >= 437) other.add(n, x, v);
  }
  CHECK(response.result().cycle_amplitudes == other.result().cycle_amplitudes);
  CHECK(response.result().rms_displacement == other.result().rms_displacement);
  CHECK(response.result().cycle_amplitudes.size() == 10);
}

TEST_CASE("nothing in the window or no whole cycle") {
  ResponseAccumulator response({1.0, 2.0}, 5.0, 0.01);
  CHECK(response.result().rms_displacement == 0.0);
  for (int n = 0; n <= 200; ++n) response.add(n, n < 100 ? 99.0 : 1.0, 0.0);
  CHECK(response.result().rms_displacement == 1.0);
  CHECK(response.result().peak_displacement == 1.0);
  CHECK(std::isnan(response.result().amplitude));
  CHECK_FALSE(response.result().steady);
}
