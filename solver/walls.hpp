// The enclosure's walls as the kernels see them, and where a centre may be.
#pragma once

#include "kernels/arguments.hpp"
#include "solver/scene.hpp"

#include <string>
#include <vector>

namespace grandamp {

struct Wall {
  std::string name;  ///< "x = 0", "side", ...: for messages
  bool side = false; ///< of a cylinder; else a plane
  kernels::WallSurface surface;
};

/// Box: six planes. Cylinder: the side, then its two ends.
std::vector<Wall> make_walls(const Enclosure& enclosure);

/// How far a point is inside of a wall; negative outside, m.
double distance_inside(const Wall& wall, const kernels::PositionRow& centre);

} // namespace grandamp
