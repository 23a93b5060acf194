// The closing speed that a scene is expected to bring about, before anything has run.
#pragma once

#include "solver/scene.hpp"

#include <string>

namespace grandamp {

struct ImpactSpeed {
  double speed = 0.0; ///< m/s; never zero
  std::string reason; ///< what it rests on
};

/// Closing speed of two granules to expect, from the granules' first velocities, the bare enclosure's motion over the
/// run and the fall under gravity. Granules among themselves may come to more: the run watches the speeds that it
/// meets.
ImpactSpeed estimate_impact_speed(const Scene& scene);

} // namespace grandamp
