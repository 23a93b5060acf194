// `time.step = "adaptive"`: a step that contacts met make too long is taken in 3, 9 or 27 parts. An odd number of parts
// divides the interval from t_(n-1/2) to t_(n+1/2) so that its middle part is centred at t_n: half-step velocities, the
// structure's state and what is told at t_n stay where they are, whatever the number of parts.
#pragma once

#include "solver/plan.hpp"

#include <array>
#include <cstdint>

namespace grandamp {

/// Decides from speeds that were met, which a checkpoint holds: a run that is resumed decides alike.
class StepReview {
public:
  static constexpr std::array<std::int64_t, 4> parts{1, 3, 9, 27};
  /// Steps after which fewer parts may do again.
  static constexpr std::int64_t interval = 256;

  struct State {
    std::int64_t level = 0;   ///< into `parts`
    double speed = 0.0;       ///< largest since the last review, m/s
    std::int64_t refined = 0; ///< steps that were taken in parts
    std::int64_t finest = 0;  ///< largest level so far
  };

  StepReview() = default;
  /// Off unless the scene asks for it.
  explicit StepReview(const Plan& plan);

  bool on() const noexcept { return on_; }
  /// Into how many parts step `step_number` is to be taken, as a level; counts it.
  std::size_t level_of(std::int64_t step_number);
  /// A closing speed of a contact, or a speed relative to the enclosure, at which a granule will meet a wall; m/s.
  void met(double speed) noexcept { state_.speed = speed > state_.speed ? speed : state_.speed; }

  const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }

private:
  std::int64_t level_for(double speed) const;

  bool on_ = false;
  double contact_duration_ = 0.0; ///< at impact_speed, s
  double impact_speed_ = 0.0;     ///< m/s
  double time_step_ = 0.0;        ///< s
  State state_;
};

} // namespace grandamp
