// When the list is rebuilt, and with which skin. Every decision is a function of counts and motion, never of a clock.
#pragma once

#include "solver/scene.hpp"

#include <cstdint>

namespace grandamp {

/// Finds the skin with the least work per step: candidates tested at every step against rebuilds. Climbs by trial,
/// from counts alone, a step of 12 % at a time. A plain struct: all of it is state of the run.
struct SkinTuner {
  bool active = false;
  double skin = 0.0;  ///< in force, m
  double least = 0.0; ///< bounds, m
  double largest = 0.0;
  double factor = 1.12;                 ///< of the present direction
  double last_cost = 0.0;               ///< 0: none yet
  std::int64_t rebuilds = 0, steps = 0; ///< of the present trial
  double candidates = 0.0;              ///< per granule, summed over rebuilds

  /// At a rebuild: what the list that is given up had, and how long it lasted. May change `skin`.
  void note(double candidates_per_granule, std::int64_t interval);
};

/// The age of the list under a policy. A plain struct: all of it is state of the run.
struct ListAge {
  std::int64_t steps = 0;   ///< since the list was built
  double travelled = 0.0;   ///< sum of v_max dt, relative to the enclosure, m
  double farthest = 0.0;    ///< displacement: the largest since the list was built, m
  std::int64_t allowed = 0; ///< predicted: interval set at the rebuild, steps
  bool built = false;
};

/// Whether the list must be rebuilt before forces are taken at the present positions.
bool rebuild_due(const VerletControl& control, const ListAge& age, double skin);

/// The paper's interval, int(s / (2 beta v_max dt)), at most U_L and at least 1.
std::int64_t predicted_interval(const VerletControl& control, double skin, double max_speed, double time_step);

} // namespace grandamp
