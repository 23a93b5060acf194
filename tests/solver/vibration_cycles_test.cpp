// Cycles of a free vibration: known signals with a known damping.
#include "solver/vibration_cycles.hpp"

#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <numbers>

using namespace grandamp;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double mass = 0.1, circular = 100.0;

/// x and v of a damped oscillator let go at x0 with v0.
struct Oscillator {
  double zeta, x0, v0, offset = 0.0;

  std::pair<double, double> at(double t) const {
    const double damped = circular * std::sqrt(1.0 - zeta * zeta), decay = std::exp(-zeta * circular * t);
    const double b = (v0 + zeta * circular * x0) / damped;
    const double c = std::cos(damped * t), s = std::sin(damped * t);
    return {offset + decay * (x0 * c + b * s),
            decay * ((b * damped - zeta * circular * x0) * c - (x0 * damped + zeta * circular * b) * s)};
  }
};

std::vector<VibrationCycle> cycles(const Oscillator& oscillator, double duration, double dt,
                                   const std::function<double(std::int64_t)>& noise = {}) {
  VibrationCycles found(mass, dt);
  for (std::int64_t n = 0; n <= std::llround(duration / dt); ++n) {
    const auto [x, v] = oscillator.at(static_cast<double>(n) * dt);
    found.add(n, x + (noise ? noise(n) : 0.0), v);
  }
  return found.result();
}

} // namespace

TEST_CASE("viscous damping is found as what it is, from rest on either side and from a push") {
  for (const double zeta : {1.0e-4, 0.01, 0.1, 0.4})
    for (const auto& [x0, v0] : {std::pair{0.01, 0.0}, {-0.01, 0.0}, {0.0, 2.0}, {0.0, -2.0}, {0.005, 1.0}}) {
      CAPTURE(zeta);
      CAPTURE(x0);
      const Oscillator oscillator{zeta, x0, v0, 0.003};
      const double period = 2.0 * pi / (circular * std::sqrt(1.0 - zeta * zeta));
      const std::vector<VibrationCycle> found = cycles(oscillator, 10.5 * period, 1.0e-4);
      REQUIRE(found.size() >= (zeta < 0.2 ? 7 : 1));
      for (std::size_t k = 0; k < found.size(); ++k) {
        const double capacity = 1.0 - std::exp(-4.0 * pi * zeta / std::sqrt(1.0 - zeta * zeta));
        CHECK(found[k].specific_damping_capacity == doctest::Approx(capacity).epsilon(1.0e-5).scale(1.0e-3));
        CHECK(found[k].damping_ratio == doctest::Approx(zeta).epsilon(1.0e-5).scale(1.0e-3));
        if (k > 0) CHECK(found[k].start - found[k - 1].start == doctest::Approx(period).epsilon(2.5e-3));
      }
    }
}

TEST_CASE("amplitude and energy of the cycles of a structure let go") {
  const double zeta = 0.02, root = std::sqrt(1.0 - zeta * zeta);
  const std::vector<VibrationCycle> found = cycles({zeta, 0.01, 0.0}, 1.0, 1.0e-4);
  REQUIRE(found.size() == 15);
  const double fall = std::exp(-2.0 * pi * zeta / root);
  double start = 0.01;
  for (const VibrationCycle& cycle : found) {
    CHECK(cycle.amplitude == doctest::Approx(0.5 * start * (1.0 + std::sqrt(fall))).epsilon(1.0e-6));
    // The speed is largest where the force is none: a phase acos(zeta) after the turn.
    const double speed = start * circular * std::exp(-zeta / root * std::acos(zeta));
    CHECK(cycle.peak_kinetic_energy == doctest::Approx(0.5 * mass * speed * speed).epsilon(1.0e-6));
    start *= fall;
  }
}

TEST_CASE("knocks are no cycles, and what hardly swings has none") {
  const auto knocks = [](std::int64_t n) { return n % 7 == 0 ? 2.0e-5 : 0.0; };
  CHECK(cycles({0.02, 0.01, 0.0}, 1.0, 1.0e-4, knocks).size() == 15);
  CHECK(cycles({0.9999, 0.01, 0.0}, 1.0, 1.0e-4).empty());
  CHECK(cycles({0.1, 0.0, 0.0}, 1.0, 1.0e-4).empty());
}

TEST_CASE("the state of the cycles goes on by the same bits") {
  const Oscillator oscillator{0.01, 0.0, 1.0};
  VibrationCycles whole(mass, 1.0e-4), part(mass, 1.0e-4);
  for (std::int64_t n = 0; n < 9000; ++n) {
    const auto [x, v] = oscillator.at(1.0e-4 * static_cast<double>(n));
    whole.add(n, x, v);
    part.add(n, x, v);
    if (n % 1234 == 0) {
      VibrationCycles other(mass, 1.0e-4);
      REQUIRE(other.restore(part.state()));
      part = other;
    }
  }
  CHECK(whole.state() == part.state());
  CHECK_FALSE(part.restore({1.0, 2.0}));
}
