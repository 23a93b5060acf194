#include "solver/vibration_cycles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

/// Of three samples at even distances, the middle one the largest: the top of the parabola through them, so that a
/// peak does not depend on where in a step it falls.
double top(double before, double at, double after) {
  const double curvature = before - 2.0 * at + after;
  return curvature < 0.0 ? at - (after - before) * (after - before) / (8.0 * curvature) : at;
}

/// A start at this share of the swing's own speed is a start from rest.
constexpr double rest = 1.0e-3;

} // namespace

VibrationCycles::VibrationCycles(double mass, double time_step) : mass_(mass), time_step_(time_step) {}

void VibrationCycles::look_for_peaks(double velocity) {
  speed_up_ = std::max(speed_up_, velocity);
  speed_down_ = std::max(speed_down_, -velocity);
  if (samples_ < 2) return;
  if (velocity_ >= velocity_before_ && velocity_ >= velocity)
    speed_up_ = std::max(speed_up_, top(velocity_before_, velocity_, velocity));
  if (velocity_ <= velocity_before_ && velocity_ <= velocity)
    speed_down_ = std::max(speed_down_, top(-velocity_before_, -velocity_, -velocity));
}

void VibrationCycles::add(std::int64_t step_number, double displacement, double velocity) {
  const double time = static_cast<double>(step_number) * time_step_;
  largest_ = std::max(largest_, std::abs(displacement));
  look_for_peaks(velocity);
  if (samples_ == 0) {
    initial_velocity_ = velocity;
    turn_ = turn_before_ = highest_ = lowest_ = displacement;
    turn_at_ = highest_at_ = lowest_at_ = time;
    rising_ = velocity > 0.0 || (velocity == 0.0 && displacement < 0.0);
  }
  double high = displacement, low = displacement;
  if (samples_ > 0 && velocity_ * velocity < 0.0) {
    // The turning point between two steps, the velocity taken to change evenly.
    const double turn = displacement_ + 0.5 * velocity_ * (velocity_ / (velocity_ - velocity)) * time_step_;
    high = std::max(high, turn);
    low = std::min(low, turn);
  }
  if (high > highest_) {
    highest_ = high;
    highest_at_ = time;
  }
  if (low < lowest_) {
    lowest_ = low;
    lowest_at_ = time;
  }
  const double wiggle = std::max(0.05 * std::abs(turn_ - turn_before_), 1.0e-3 * largest_);
  const bool turned_down = rising_ && displacement < highest_ - wiggle;
  const bool turned_up = !rising_ && displacement > lowest_ + wiggle;
  if (turned_down) finish_swing(highest_, highest_at_, speed_up_);
  if (turned_up) finish_swing(lowest_, lowest_at_, speed_down_);
  if (turned_down || turned_up) {
    highest_ = lowest_ = displacement;
    highest_at_ = lowest_at_ = time;
  }
  velocity_before_ = velocity_;
  velocity_ = velocity;
  displacement_ = displacement;
  ++samples_;
}

void VibrationCycles::finish_swing(double turn, double time, double& speed) {
  const bool first = swings_.empty() && turn_at_ == 0.0 && turn_ == turn_before_;
  const bool from_rest = std::abs(initial_velocity_) <= rest * speed;
  if (speed > 0.0 && (!first || from_rest)) swings_.push_back({turn_at_, turn_, turn, speed});
  turn_before_ = turn_;
  turn_ = turn;
  turn_at_ = time;
  speed = 0.0;
  rising_ = !rising_;
}

std::vector<VibrationCycle> VibrationCycles::result() const {
  std::vector<VibrationCycle> cycles;
  for (std::size_t k = 0; k + 2 < swings_.size(); k += 2) {
    const Swing &there = swings_[k], &back = swings_[k + 1], &next = swings_[k + 2];
    const auto [low, high] = std::minmax({there.from, there.to, back.to});
    VibrationCycle cycle;
    cycle.start = there.start;
    cycle.amplitude = 0.5 * (high - low);
    cycle.peak_kinetic_energy = 0.5 * mass_ * there.speed * there.speed;
    const double left = (next.speed / there.speed) * (next.speed / there.speed);
    cycle.specific_damping_capacity = 1.0 - left;
    // Viscous damping of this ratio would leave as much: left = exp(-4 pi zeta / sqrt(1 - zeta^2)).
    const double decrement = -0.5 * std::log(left);
    cycle.damping_ratio = decrement / std::hypot(2.0 * std::numbers::pi, decrement);
    cycles.push_back(cycle);
  }
  return cycles;
}

std::vector<double> VibrationCycles::state() const {
  std::vector<double> numbers{static_cast<double>(samples_),
                              displacement_,
                              velocity_,
                              velocity_before_,
                              initial_velocity_,
                              largest_,
                              rising_ ? 1.0 : 0.0,
                              highest_,
                              highest_at_,
                              lowest_,
                              lowest_at_,
                              turn_,
                              turn_at_,
                              turn_before_,
                              speed_up_,
                              speed_down_};
  for (const Swing& swing : swings_) numbers.insert(numbers.end(), {swing.start, swing.from, swing.to, swing.speed});
  return numbers;
}

bool VibrationCycles::restore(const std::vector<double>& numbers) {
  constexpr std::size_t head = 16, row = 4;
  if (numbers.size() < head || (numbers.size() - head) % row != 0) return false;
  std::size_t at = 0;
  samples_ = static_cast<std::int64_t>(numbers[at++]);
  for (double* to : {&displacement_, &velocity_, &velocity_before_, &initial_velocity_, &largest_}) *to = numbers[at++];
  rising_ = numbers[at++] != 0.0;
  for (double* to :
       {&highest_, &highest_at_, &lowest_, &lowest_at_, &turn_, &turn_at_, &turn_before_, &speed_up_, &speed_down_})
    *to = numbers[at++];
  swings_.clear();
  for (; at < numbers.size(); at += row)
    swings_.push_back({numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]});
  return true;
}

} // namespace grandamp
