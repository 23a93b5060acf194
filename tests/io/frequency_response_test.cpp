// Frequency responses from records of a linear oscillator, against its closed form.
#include "io/frequency_response.hpp"
#include "io/run.hpp"
#include "tests/support/oscillator_record.hpp"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <string>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double low = 10.0, high = 22.0;
const LinearOscillator oscillator; // 1 % of critical damping at 15.9 Hz

std::string refusal(const ResponseHistory& history, const ExcitedBand& drive, const ResponseSettings& settings = {}) {
  try {
    estimate_response(history, drive, oscillator.host(), settings);
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("one mode is fitted exactly through its own response, at any damping") {
  for (const double damping : {0.02, 0.2, 2.0, 8.0}) {
    CAPTURE(damping);
    const LinearOscillator mode{.damping = damping};
    std::vector<double> frequency;
    std::vector<std::complex<double>> response;
    for (double f = 10.0; f < 22.0; f += 0.05) {
      frequency.push_back(f);
      response.push_back(mode.response(f));
    }
    const ResonanceFit fit = fit_resonance(frequency, response);
    REQUIRE(fit.found);
    CHECK(fit.mass == doctest::Approx(0.1));
    CHECK(fit.stiffness == doctest::Approx(1000.0));
    CHECK(fit.damping == doctest::Approx(damping));
    CHECK(fit.natural_frequency == doctest::Approx(mode.natural_frequency()));
    CHECK(fit.damping_ratio == doctest::Approx(damping / 20.0));
    CHECK(fit.peak_magnitude == doctest::Approx(std::abs(mode.response(fit.peak_frequency))));
    for (const double off : {-0.01, 0.01})
      CHECK(fit.peak_magnitude > std::abs(mode.response(fit.peak_frequency + off)));
  }
}

TEST_CASE("whole periods of a periodic random force leak nothing") {
  const ExcitedBand drive{ResponseMethod::periodic, low, high, 8.0};
  const auto rows = oscillator.record(even_times(32.0, 5e-4), periodic_force(low, high, 8.0, 1));
  const FrequencyResponse found = estimate_response(rows, drive, oscillator.host());
  CHECK(found.spectra.segments == 3);
  CHECK(found.settling == doctest::Approx(8.0));
  CHECK(found.segment == 8.0);
  CHECK(found.even());
  CHECK(found.spectra.frequency.size() == 97);
  CHECK(found.bias == 0.0);
  const double error = largest_error(found, oscillator);
  MESSAGE("largest error from the peak down to half of it: " << 100.0 * error << " %");
  CHECK(error < 0.002);
  CHECK(found.mean_coherence() > 0.9999);
  CHECK(found.fit.damping_ratio == doctest::Approx(0.01).epsilon(0.003));
  CHECK(found.fit.natural_frequency == doctest::Approx(oscillator.natural_frequency()).epsilon(1e-4));
}

TEST_CASE("sweeps that follow each other are a periodic force") {
  const ExcitedBand drive{ResponseMethod::periodic, low, high, 10.0};
  const auto rows = oscillator.record(even_times(40.0, 5e-4), chirp_force(low, high, 10.0));
  const FrequencyResponse found = estimate_response(rows, drive, oscillator.host());
  CHECK(found.spectra.segments == 3);
  CHECK(largest_error(found, oscillator) < 0.002);
  CHECK(found.mean_coherence() > 0.9999);
}

TEST_CASE("one sweep from rest is read without a window at its start, and without a coherence") {
  const ExcitedBand drive{ResponseMethod::transient, low, high, 0.0};
  const auto rows = oscillator.record(even_times(40.0, 5e-4), chirp_force(low, high, 40.0));
  const FrequencyResponse found = estimate_response(rows, drive, oscillator.host());
  CHECK(!found.has_coherence());
  CHECK(std::isnan(found.mean_coherence()));
  const double error = largest_error(found, oscillator);
  MESSAGE("largest error from the peak down to half of it: " << 100.0 * error << " %");
  CHECK(error < 0.005);
  CHECK(found.fit.damping_ratio == doctest::Approx(0.01).epsilon(0.005));
  CHECK(found.fit.peak_magnitude == doctest::Approx(std::abs(oscillator.response(15.915))).epsilon(0.005));
}

TEST_CASE("a blow is read as far as its force has power") {
  const auto blow = [](double t) { return t < 0.02 ? std::sin(std::numbers::pi * t / 0.02) : 0.0; };
  const ExcitedBand drive{ResponseMethod::transient, 0.0, std::numeric_limits<double>::infinity(), 0.0};
  const FrequencyResponse found =
      estimate_response(oscillator.record(even_times(12.0, 5e-4), blow), drive, oscillator.host());
  CHECK(found.spectra.frequency.front() < 0.1);
  CHECK(found.spectra.frequency.back() > 60.0);
  CHECK(found.spectra.frequency.back() < 75.0); // the half sine's first zero is at 75 Hz
  CHECK(largest_error(found, oscillator) < 0.005);
}

TEST_CASE("Welch's segments of a random force are long enough for 1 % at the peak") {
  const ExcitedBand drive{ResponseMethod::welch, low, high, 0.0};
  const auto rows = oscillator.record(even_times(600.0, 2e-3), white_force(5));
  const FrequencyResponse found = estimate_response(rows, drive, oscillator.host());
  CHECK(found.segment == doctest::Approx(std::sqrt(4.0 / 0.015) / oscillator.bandwidth()));
  CHECK(found.spectra.segments >= 20);
  CHECK(found.bias == doctest::Approx(-0.005).epsilon(0.1));
  MESSAGE("peak: " << 100.0 * (found.fit.peak_magnitude / std::abs(oscillator.response(15.915)) - 1.0)
                   << " %, largest of a line: " << 100.0 * largest_error(found, oscillator) << " %");
  CHECK(found.fit.peak_magnitude == doctest::Approx(std::abs(oscillator.response(15.915))).epsilon(0.01));
  CHECK(found.mean_coherence() > 0.97);
}

TEST_CASE("segments that are too short lower the peak as the bias says, and that is told") {
  const ExcitedBand drive{ResponseMethod::welch, low, high, 0.0};
  const auto rows = oscillator.record(even_times(600.0, 2e-3), white_force(6));
  const FrequencyResponse found = estimate_response(rows, drive, oscillator.host(), {.segment = 16.0});
  const auto top = [&](std::size_t k) { return std::abs(found.response[k]) / std::abs(found.bare[k]) - 1.0; };
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < found.response.size(); ++k)
    if (std::abs(found.spectra.frequency[k] - 15.915) < std::abs(found.spectra.frequency[nearest] - 15.915))
      nearest = k;
  CHECK(top(nearest) == doctest::Approx(hann_bias(oscillator.bandwidth(), 16.0)).epsilon(0.25));
  REQUIRE(!found.notes.empty());
  CHECK(has(found.notes.back(), "lowers the peak"));
}

TEST_CASE("rows that are not quite even in time make no difference") {
  std::mt19937_64 engine(4);
  std::uniform_real_distribution<double> shift(-2e-4, 2e-4);
  std::vector<double> times = even_times(32.0, 1e-3);
  for (std::size_t n = 1; n + 1 < times.size(); ++n) times[n] += shift(engine);
  const ExcitedBand drive{ResponseMethod::periodic, low, high, 8.0};
  const auto rows = oscillator.record(times, periodic_force(low, high, 8.0, 1));
  CHECK(largest_error(estimate_response(rows, drive, oscillator.host()), oscillator) < 0.004);
}

TEST_CASE("noise that the force does not explain lowers the coherence, not H1") {
  auto rows = oscillator.record(even_times(200.0, 1e-3), periodic_force(low, high, 8.0, 1));
  std::mt19937_64 engine(9);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (double& x : rows.displacement) x += noise(engine);
  const FrequencyResponse found =
      estimate_response(rows, {ResponseMethod::periodic, low, high, 8.0}, oscillator.host());
  CHECK(found.mean_coherence() < 0.9999);
  CHECK(found.mean_coherence() > 0.9);
  std::size_t within = 0;
  for (std::size_t k = 0; k < found.response.size(); ++k)
    within +=
        std::abs(std::abs(found.response[k]) / std::abs(found.bare[k]) - 1.0) < 2.0 * found.spectra.random_error(k) ? 1
                                                                                                                    : 0;
  CHECK(static_cast<double>(within) > 0.85 * static_cast<double>(found.response.size()));
}

TEST_CASE("records that tell nothing are refused with the reason") {
  const ExcitedBand periodic{ResponseMethod::periodic, low, high, 8.0}, welch{ResponseMethod::welch, low, high, 0.0};
  const auto force = periodic_force(low, high, 8.0, 1);
  CHECK(has(refusal(oscillator.record(even_times(5.0, 1e-3), force), periodic), "shorter than one period"));
  CHECK(has(refusal(oscillator.record(even_times(0.01, 1e-3), force), welch), "11 rows"));
  CHECK(has(refusal(oscillator.record(even_times(20.0, 0.02), force), welch), "output.history_interval"));
  CHECK(
      has(refusal(oscillator.record(even_times(20.0, 1e-3), [](double) { return 0.0; }), welch), "there is no force"));
  CHECK(has(refusal(oscillator.record(even_times(20.0, 1e-3), force), welch, {.segment = 30.0}), "longer than"));
  CHECK(has(refusal(oscillator.record(even_times(20.0, 1e-3), force), welch, {.settling = 20.0}), "leaves nothing"));
  CHECK(has(refusal(oscillator.record(even_times(20.0, 1e-3), force), {ResponseMethod::welch, 15.0, 15.001, 0.0}),
            "lines between"));
  auto damaged = oscillator.record(even_times(20.0, 1e-3), force);
  damaged.force[100] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(estimate_response(damaged, welch, oscillator.host()), FileError);
  damaged = oscillator.record(even_times(20.0, 1e-3), force);
  damaged.time[100] = damaged.time[99];
  CHECK_THROWS_AS(estimate_response(damaged, welch, oscillator.host()), FileError);
}

TEST_CASE("what limits a response is told: settling, one period, rows per period, a tail") {
  const auto notes = [](const ResponseHistory& history, const ExcitedBand& drive) {
    std::string all;
    for (const std::string& note : estimate_response(history, drive, oscillator.host()).notes) all += note + "\n";
    return all;
  };
  const auto force = periodic_force(low, high, 4.0, 1);
  CHECK(has(notes(oscillator.record(even_times(9.0, 1e-3), force), {ResponseMethod::periodic, low, high, 4.0}),
            "settling cut"));
  CHECK(has(notes(oscillator.record(even_times(9.0, 1e-3), force), {ResponseMethod::periodic, low, high, 4.0}),
            "one period"));
  CHECK(has(notes(oscillator.record(even_times(60.0, 8e-3), force), {ResponseMethod::welch, low, high, 0.0}),
            "cut at 15.6"));
  const auto sweep = oscillator.record(even_times(5.0, 1e-3), chirp_force(low, high, 5.0));
  CHECK(has(notes(sweep, {ResponseMethod::transient, low, high, 0.0}), "is left at the end"));
}
