// Free vibration, cycle by cycle: how far the structure swings and what a cycle costs it.
#pragma once

#include "solver/simulation.hpp"

#include <cstdint>
#include <vector>

namespace grandamp {

/// Takes the structure's displacement and velocity at every step from t = 0. A cycle is two swings, from one turning
/// point to the next but one; wiggles below a twentieth of the last swing are none. Its peak kinetic energy is that of
/// its first swing, and what it lost shows in the first swing of the next one: so both are of the same direction, and a
/// weight that has moved the rest does not matter. The first swing counts only if it starts from rest.
class VibrationCycles {
public:
  /// mass: of the structure, kg
  VibrationCycles(double mass, double time_step);

  void add(std::int64_t step_number, double displacement, double velocity);
  /// The whole cycles so far.
  std::vector<VibrationCycle> result() const;

  /// Everything that is remembered, as plain numbers; restore() takes what state() gave.
  std::vector<double> state() const;
  /// Numbers of any other kind leave it as it was; returns whether they were taken.
  bool restore(const std::vector<double>& numbers);

private:
  /// From one turning point to the next.
  struct Swing {
    double start = 0.0; ///< s
    double from = 0.0;  ///< m
    double to = 0.0;    ///< m
    double speed = 0.0; ///< the largest, m/s
  };
  void look_for_peaks(double velocity);
  void finish_swing(double turn, double time, double& speed);

  double mass_;
  double time_step_;
  std::vector<Swing> swings_;
  std::int64_t samples_ = 0;
  double displacement_ = 0.0, velocity_ = 0.0, velocity_before_ = 0.0; ///< the last sample's, and the one's before
  double initial_velocity_ = 0.0;
  double largest_ = 0.0; ///< |displacement| so far, m
  bool rising_ = false;
  double highest_ = 0.0, highest_at_ = 0.0, lowest_ = 0.0, lowest_at_ = 0.0; ///< since the last turn, m, s
  double turn_ = 0.0, turn_at_ = 0.0, turn_before_ = 0.0;                    ///< m, s
  double speed_up_ = 0.0, speed_down_ = 0.0;                                 ///< largest of the swing that goes on, m/s
};

} // namespace grandamp
