// Running statistics of the structure's displacement over the window.
#pragma once

#include "solver/simulation.hpp"

#include <cstdint>
#include <vector>

namespace grandamp {

/// Takes the displacement and velocity at every step inside the window; small, copyable, its State is what a checkpoint
/// stores. Steps from the first at or after the window's start to the last at or before its end count, both included.
/// Forced: the k-th period starts at the window's start and k periods; only whole ones give an amplitude.
/// Free: a cycle goes from one lowest point to the next; wiggles below a twentieth of the last swing are none.
class ResponseAccumulator {
public:
  /// Everything that is remembered. Plain values.
  struct State {
    std::int64_t samples = 0;
    double sum_of_squares = 0.0;    ///< m^2
    double peak = 0.0;              ///< largest |x|, m
    std::int64_t last_step = -1;    ///< inside the window
    double last_displacement = 0.0; ///< at last_step, m
    double last_velocity = 0.0;     ///< m/s
    // The cycle that goes on.
    std::int64_t cycle = -1; ///< forced: its number, -1 before the first; free: turning points so far
    double highest = 0.0;    ///< m
    double lowest = 0.0;     ///< m
    // Free vibration only.
    bool rising = false;
    double last_turn = 0.0;         ///< displacement at the last turning point, m
    double turn_before = 0.0;       ///< and at the one before it, m
    std::vector<double> amplitudes; ///< of whole cycles, m
  };

  /// forcing_period: s; 0 for free vibration (cycles from the displacement's own turning points).
  ResponseAccumulator(std::array<double, 2> window, double forcing_period, double time_step);

  void add(std::int64_t step_number, double displacement, double velocity);
  /// Of what has been taken so far. amplitude is NaN until there is a whole cycle.
  ResponseStatistics result() const;

  const State& state() const noexcept { return state_; }
  void restore(State state) { state_ = std::move(state); }

private:
  void add_forced(std::int64_t step_number, double highest, double lowest);
  void add_free(double highest, double lowest, double displacement);
  double start_of_period(std::int64_t period) const;
  void close_period();

  std::array<double, 2> window_;
  double forcing_period_;
  double time_step_;
  std::int64_t first_step_;
  std::int64_t last_step_;
  State state_;
};

} // namespace grandamp
