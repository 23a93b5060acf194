#include "solver/response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grandamp {

namespace {

/// Steps and periods that end where they should but for rounding are taken to end there.
constexpr double rounding = 1.0e-6;

/// Least squares of the amplitudes over their number: how much the line rises over the window, and the standard
/// deviation about it.
struct Trend {
  double rise = 0.0;
  double scatter = 0.0;
};

Trend trend_of(const std::vector<double>& amplitudes, double mean) {
  const double n = static_cast<double>(amplitudes.size()), middle = 0.5 * (n - 1.0);
  double product = 0.0, square = 0.0;
  for (std::size_t k = 0; k < amplitudes.size(); ++k) {
    const double place = static_cast<double>(k) - middle;
    product += place * (amplitudes[k] - mean);
    square += place * place;
  }
  const double slope = product / square;
  double residual = 0.0;
  for (std::size_t k = 0; k < amplitudes.size(); ++k) {
    const double off = amplitudes[k] - mean - slope * (static_cast<double>(k) - middle);
    residual += off * off;
  }
  return {std::abs(slope) * n, std::sqrt(residual / (n - 2.0))};
}

} // namespace

ResponseAccumulator::ResponseAccumulator(std::array<double, 2> window, double forcing_period, double time_step)
    : window_(window), forcing_period_(forcing_period), time_step_(time_step),
      first_step_(static_cast<std::int64_t>(std::ceil(window[0] / time_step - rounding))),
      last_step_(static_cast<std::int64_t>(std::floor(window[1] / time_step + rounding))) {}

void ResponseAccumulator::add(std::int64_t step_number, double displacement, double velocity) {
  if (step_number < first_step_ || step_number > last_step_) return;
  ++state_.samples;
  state_.sum_of_squares += displacement * displacement;
  state_.peak = std::max(state_.peak, std::abs(displacement));

  double highest = displacement, lowest = displacement;
  const double before = state_.last_velocity;
  if (state_.last_step == step_number - 1 && before * velocity < 0.0) {
    // A turning point between two steps, the velocity taken to change evenly: amplitudes then do not depend on where
    // in a step the turning point falls.
    const double turn = state_.last_displacement + 0.5 * before * (before / (before - velocity)) * time_step_;
    highest = std::max(highest, turn);
    lowest = std::min(lowest, turn);
  }
  if (forcing_period_ > 0.0)
    add_forced(step_number, highest, lowest);
  else
    add_free(highest, lowest, displacement);
  state_.last_step = step_number;
  state_.last_displacement = displacement;
  state_.last_velocity = velocity;
}

double ResponseAccumulator::start_of_period(std::int64_t period) const {
  return window_[0] + static_cast<double>(period) * forcing_period_;
}

void ResponseAccumulator::close_period() {
  state_.amplitudes.push_back(0.5 * (state_.highest - state_.lowest));
}

void ResponseAccumulator::add_forced(std::int64_t step_number, double highest, double lowest) {
  const double time = static_cast<double>(step_number) * time_step_;
  const std::int64_t period = static_cast<std::int64_t>(std::floor((time - window_[0]) / forcing_period_ + rounding));
  if (period != state_.cycle) {
    if (state_.cycle >= 0) close_period();
    state_.cycle = std::max<std::int64_t>(0, period);
    state_.highest = highest;
    state_.lowest = lowest;
    return;
  }
  state_.highest = std::max(state_.highest, highest);
  state_.lowest = std::min(state_.lowest, lowest);
}

void ResponseAccumulator::add_free(double highest, double lowest, double displacement) {
  State& s = state_;
  if (s.samples == 1) {
    s.cycle = 0;
    s.highest = s.lowest = s.last_turn = s.turn_before = displacement;
    s.rising = false;
    return;
  }
  // Granules' knocks make the displacement wiggle at its turning points; those are no cycles.
  const double wiggle = std::max(0.05 * std::abs(s.last_turn - s.turn_before), 1.0e-3 * s.peak);
  const auto turned = [&](double at) {
    s.turn_before = s.last_turn;
    s.last_turn = at;
    s.highest = s.lowest = displacement;
    ++s.cycle;
  };
  s.highest = std::max(s.highest, highest);
  s.lowest = std::min(s.lowest, lowest);
  if (s.rising && displacement < s.highest - wiggle) {
    s.rising = false;
    turned(s.highest);
  } else if (!s.rising && displacement > s.lowest + wiggle) {
    s.rising = true;
    // Two turning points at least before this one, the first of them a lowest point: a whole cycle.
    if (s.cycle >= 2) s.amplitudes.push_back(0.5 * (s.last_turn - std::min(s.turn_before, s.lowest)));
    turned(s.lowest);
  }
}

ResponseStatistics ResponseAccumulator::result() const {
  ResponseStatistics result;
  if (state_.samples == 0) return result;
  ResponseAccumulator whole = *this;
  // The last period is whole if the steps have come to its end.
  const double reached = static_cast<double>(state_.last_step) * time_step_;
  if (forcing_period_ > 0.0 && state_.cycle >= 0 &&
      reached >= start_of_period(state_.cycle + 1) - time_step_ * (1.0 + rounding))
    whole.close_period();
  result.cycle_amplitudes = std::move(whole.state_.amplitudes);
  result.rms_displacement = std::sqrt(state_.sum_of_squares / static_cast<double>(state_.samples));
  result.peak_displacement = state_.peak;
  const std::vector<double>& amplitudes = result.cycle_amplitudes;
  result.amplitude = std::numeric_limits<double>::quiet_NaN();
  if (amplitudes.empty()) return result;
  double sum = 0.0;
  for (const double amplitude : amplitudes) sum += amplitude;
  result.amplitude = sum / static_cast<double>(amplitudes.size());
  if (amplitudes.size() < 3) return result; // no scatter about a line through two
  const Trend trend = trend_of(amplitudes, result.amplitude);
  // A bare structure has no scatter: a drift below a thousandth of the amplitude is steady in any case.
  result.steady = trend.rise < std::max(trend.scatter, 1.0e-3 * result.amplitude);
  return result;
}

} // namespace grandamp
