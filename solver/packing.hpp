// First positions of the granules that a scene gives by count.
#pragma once

#include "solver/plan.hpp"

#include <functional>
#include <vector>

namespace grandamp {

/// Where granules start, by id: those given by count overlap nothing and cross no wall; explicit positions are as
/// given, and may overlap a little (below half of the smaller radius, walls by a tenth of a radius).
struct Placement {
  std::vector<Vector3> position; ///< enclosure's frame, m
  std::vector<double> radius;    ///< m
  std::vector<double> mass;      ///< kg
  std::vector<std::int32_t> population;
  std::vector<Vector3> velocity; ///< laboratory's frame, m/s: as given, or `speed` in random directions
  std::vector<Vector3> spin;     ///< rad/s
  bool to_be_poured = false;     ///< packing "settled" and granules given by count
  std::vector<Problem> notes;    ///< small overlaps of explicit positions
};

/// Deterministic in the scene's seed. "random": anywhere in the enclosure. "settled": loosely, from the bottom (against
/// gravity) upwards, to be poured by the solver. Granules given by count keep clear of those with explicit positions.
/// Throws SceneError if they do not fit, or explicit ones overlap by half a radius, coincide, or cross a wall.
/// `pulse`, if given, is called now and then; what it throws ends the search.
Placement place_granules(const Plan& plan, const std::function<void()>& pulse = {});

} // namespace grandamp
