#include "solver/walls.hpp"

#include <cmath>

namespace grandamp {

namespace {

constexpr const char* axis_names[3] = {"x", "y", "z"};

void add_ends(std::vector<Wall>& walls, std::size_t axis, double length) {
  for (const bool upper : {false, true}) {
    Wall wall;
    wall.name = std::string(axis_names[axis]) + (upper ? " = " + std::to_string(length) : " = 0");
    wall.surface.normal[axis] = upper ? 1.0 : -1.0;
    wall.surface.offset = upper ? length : 0.0;
    walls.push_back(wall);
  }
}

} // namespace

std::vector<Wall> make_walls(const Enclosure& enclosure) {
  std::vector<Wall> walls;
  if (enclosure.shape == EnclosureShape::box) {
    for (std::size_t axis = 0; axis < 3; ++axis) add_ends(walls, axis, enclosure.size[axis]);
    return walls;
  }
  Wall side;
  side.name = "side";
  side.side = true;
  const auto axis = static_cast<std::size_t>(enclosure.axis);
  for (std::size_t k = 0; k < 3; ++k) {
    side.surface.across[k] = k == axis ? 0.0 : 1.0;
    side.surface.centre[k] = k == axis ? 0.0 : 0.5 * enclosure.diameter;
  }
  side.surface.radius = 0.5 * enclosure.diameter;
  walls.push_back(side);
  add_ends(walls, axis, enclosure.height);
  return walls;
}

double distance_inside(const Wall& wall, const kernels::PositionRow& centre) {
  const double x[3] = {centre.x, centre.y, centre.z};
  const kernels::WallSurface& s = wall.surface;
  double sum = 0.0;
  if (!wall.side) {
    for (int k = 0; k < 3; ++k) sum += s.normal[k] * x[k];
    return s.offset - sum;
  }
  for (int k = 0; k < 3; ++k) {
    const double off = (x[k] - s.centre[k]) * s.across[k];
    sum += off * off;
  }
  return s.radius - std::sqrt(sum);
}

} // namespace grandamp
