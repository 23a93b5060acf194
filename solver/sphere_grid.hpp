// Finds the spheres near a point while spheres are still being added: for packing, where sizes may differ widely.
#pragma once

#include "solver/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grandamp {

/// Spheres in a box from the origin, sorted by size into levels (a factor of two each) of cells of their own: one big
/// sphere among many small ones then costs no more than its own surroundings.
class SphereGrid {
public:
  /// `position` and `radius` stay the caller's, and must outlive the grid; a sphere in it must not be moved.
  SphereGrid(const Vector3& box, const std::vector<Vector3>& position, const std::vector<double>& radius)
      : position_(position), radius_(radius), next_(radius.size(), none) {
    if (radius.empty()) return;
    smallest_ = *std::min_element(radius.begin(), radius.end());
    for (const double r : radius) {
      const std::size_t k = level_of(r);
      if (levels_.size() <= k) levels_.resize(k + 1);
      levels_[k].largest = std::max(levels_[k].largest, r);
      ++levels_[k].expected;
    }
    for (Level& level : levels_) {
      if (level.expected == 0) continue;
      const double share = std::cbrt(box[0] * box[1] * box[2] / static_cast<double>(level.expected));
      const double length = std::max(2.0 * level.largest, share);
      std::size_t total = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        level.cells[k] = std::max(1, static_cast<int>(std::min(box[k] / length, 1.0e6)));
        level.inverse[k] = level.cells[k] / box[k];
        total *= static_cast<std::size_t>(level.cells[k]);
      }
      level.head.assign(total, none);
    }
  }

  void insert(std::size_t index) {
    Level& level = levels_[level_of(radius_[index])];
    std::int32_t& head =
        level.head[cell_index(level, cell_at(level, position_[index], 0), cell_at(level, position_[index], 1),
                              cell_at(level, position_[index], 2))];
    next_[index] = head;
    head = static_cast<std::int32_t>(index);
    level.occupied = true;
  }

  void clear() {
    for (Level& level : levels_) {
      std::fill(level.head.begin(), level.head.end(), none);
      level.occupied = false;
    }
  }

  /// Calls visit(index, squared distance) for every sphere in the grid whose surface is closer than `gap` to that of a
  /// sphere of `radius` at `centre`. visit returns false to stop; so does this then.
  template <class Visit> bool visit_near(const Vector3& centre, double radius, double gap, Visit&& visit) const {
    for (const Level& level : levels_) {
      if (!level.occupied) continue;
      const double reach = radius + level.largest + gap;
      int first[3], last[3];
      for (std::size_t k = 0; k < 3; ++k) {
        Vector3 corner = centre;
        corner[k] = centre[k] - reach;
        first[k] = cell_at(level, corner, k);
        corner[k] = centre[k] + reach;
        last[k] = cell_at(level, corner, k);
      }
      for (int z = first[2]; z <= last[2]; ++z)
        for (int y = first[1]; y <= last[1]; ++y)
          for (int x = first[0]; x <= last[0]; ++x)
            for (std::int32_t i = level.head[cell_index(level, x, y, z)]; i != none;
                 i = next_[static_cast<std::size_t>(i)]) {
              const std::size_t index = static_cast<std::size_t>(i);
              const Vector3& p = position_[index];
              const double dx = p[0] - centre[0], dy = p[1] - centre[1], dz = p[2] - centre[2];
              const double square = dx * dx + dy * dy + dz * dz, limit = radius + radius_[index] + gap;
              if (square < limit * limit && !visit(index, square)) return false;
            }
    }
    return true;
  }

  /// Whether a sphere would overlap none of those in the grid.
  bool is_free(const Vector3& centre, double radius) const {
    return visit_near(centre, radius, 0.0, [](std::size_t, double) { return false; });
  }

private:
  static constexpr std::int32_t none = -1;

  struct Level {
    double largest = 0.0;
    std::size_t expected = 0;
    bool occupied = false;
    int cells[3] = {1, 1, 1};
    double inverse[3] = {0.0, 0.0, 0.0};
    std::vector<std::int32_t> head;
  };

  std::size_t level_of(double radius) const {
    return static_cast<std::size_t>(std::max(0, std::ilogb(radius / smallest_)));
  }
  static int cell_at(const Level& level, const Vector3& p, std::size_t k) {
    return static_cast<int>(std::clamp(std::floor(p[k] * level.inverse[k]), 0.0, level.cells[k] - 1.0));
  }
  static std::size_t cell_index(const Level& level, int x, int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(level.cells[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(level.cells[0]) +
           static_cast<std::size_t>(x);
  }

  const std::vector<Vector3>& position_;
  const std::vector<double>& radius_;
  std::vector<std::int32_t> next_;
  double smallest_ = 1.0;
  std::vector<Level> levels_;
};

} // namespace grandamp
