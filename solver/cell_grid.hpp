// The link-cell grid: granules sorted by cell, so that the neighbours of a cell are a few contiguous ranges of rows.
#pragma once

#include "solver/granules.hpp"
#include "solver/scene.hpp"
#include "solver/team.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grandamp {

/// Cells of at least the length asked for, over a box of `size`. The axis with most cells is the slowest of the order.
struct GridShape {
  std::array<int, 3> axis{0, 1, 2};  ///< fastest, middle, slowest
  std::array<int, 3> cells{1, 1, 1}; ///< along those axes
  std::array<double, 3> inverse_length{0.0, 0.0, 0.0};

  /// The cell of a coordinate (m) along axis[k]; one at the edge for what is outside, or not finite.
  int cell_along(double coordinate, std::size_t k) const {
    const double x = coordinate * inverse_length[k];
    const int last = cells[k] - 1;
    return x > 0.0 ? (x < last ? static_cast<int>(x) : last) : 0;
  }
  std::size_t index(int fast, int middle, int slow) const {
    return (static_cast<std::size_t>(slow) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(middle)) *
               static_cast<std::size_t>(cells[0]) +
           static_cast<std::size_t>(fast);
  }
  /// The cell of a granule's centre, wherever that is.
  std::size_t cell_of(const kernels::PositionRow& row) const {
    const auto along = [&](std::size_t k) { return cell_along((&row.x)[axis[k]], k); };
    return index(along(0), along(1), along(2));
  }
  std::size_t total() const {
    return static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(cells[2]);
  }
};

/// Longer cells are taken where there would be far more cells than granules.
GridShape make_grid_shape(const Vector3& size, double cell_length, std::size_t granules);

class CellGrid {
public:
  /// Sorts the granules by cell, granules of one cell in the order they had. Force rows are scratch afterwards.
  /// A centre outside, or not finite, goes to a cell at the edge.
  void sort(Granules& granules, const GridShape& shape, const Team& team);

  const GridShape& shape() const noexcept { return shape_; }
  /// First row of each cell; one more entry than cells.
  const std::vector<std::uint32_t>& start() const noexcept { return start_; }

  /// First row of each cell of a line of cells along the fastest axis, and where the line ends.
  const std::uint32_t* row_start(int middle, int slow) const { return start_.data() + index(0, middle, slow); }
  std::uint32_t cell_start(int fast, int middle, int slow) const { return start_[index(fast, middle, slow)]; }
  std::size_t index(int fast, int middle, int slow) const { return shape_.index(fast, middle, slow); }
  /// First row of a layer of cells along the slowest axis; layer == cells[2] gives the end.
  std::uint32_t layer_start(int layer) const { return start_[index(0, 0, layer)]; }

private:
  GridShape shape_;
  std::vector<std::uint32_t> start_;
  /// Scratch of sort(): of each piece and cell its granules, then where the next of them goes.
  std::vector<std::vector<std::uint32_t>> counts_;
  RowArray<std::uint32_t> cell_of_;
  RowArray<std::uint32_t> order_;
};

} // namespace grandamp
