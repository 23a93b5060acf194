#include "solver/cell_grid.hpp"

#include "solver/measures.hpp"

#include <algorithm>
#include <cmath>

namespace grandamp {

GridShape make_grid_shape(const Vector3& size, double cell_length, std::size_t granules) {
  const double limit = 4.0 * static_cast<double>(granules) + 512.0;
  std::array<double, 3> cells{};
  // Without granules there is no length to ask for: one cell.
  for (double length = cell_length > 0.0 ? cell_length : norm(size);; length *= 1.1) {
    double total = 1.0;
    for (std::size_t k = 0; k < 3; ++k) total *= cells[k] = std::max(1.0, std::floor(size[k] / length));
    if (total <= limit) break;
  }
  GridShape shape;
  std::sort(shape.axis.begin(), shape.axis.end(), [&](int a, int b) {
    return cells[static_cast<std::size_t>(a)] != cells[static_cast<std::size_t>(b)]
               ? cells[static_cast<std::size_t>(a)] < cells[static_cast<std::size_t>(b)]
               : a < b;
  });
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(shape.axis[k]);
    shape.cells[k] = static_cast<int>(cells[axis]);
    shape.inverse_length[k] = cells[axis] / size[axis];
  }
  return shape;
}

namespace {

/// Granules are cut into this many pieces for the parallel count. Their order comes out the same whatever it is.
std::size_t pieces_for(std::uint32_t count, const Team& team) {
  return count < 20000 ? 1 : static_cast<std::size_t>(std::min(team.threads(), 8));
}

std::uint32_t piece_begin(std::uint32_t count, std::size_t pieces, std::size_t piece) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(count) * piece / pieces);
}

} // namespace

void CellGrid::sort(Granules& granules, const GridShape& shape, const Team& team) {
  shape_ = shape;
  const std::uint32_t count = granules.count();
  if (cell_of_.size() < count) {
    cell_of_.reset(count);
    order_.reset(count);
  }
  const std::size_t cells = shape_.total();
  const std::size_t pieces = pieces_for(count, team);
  start_.assign(cells + 1, 0);
  counts_.resize(pieces);

  team.each(pieces, [&](std::size_t piece) {
    std::vector<std::uint32_t>& counts = counts_[piece];
    counts.assign(cells, 0);
    const std::uint32_t end = piece_begin(count, pieces, piece + 1);
    for (std::uint32_t i = piece_begin(count, pieces, piece); i < end; ++i) {
      const std::size_t cell = shape_.cell_of(granules.position[i]); // whatever its place: guards come later
      cell_of_[i] = static_cast<std::uint32_t>(cell);
      ++counts[cell];
    }
    granules.keep_shares(piece_begin(count, pieces, piece), end);
  });
  std::uint32_t next = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    start_[cell] = next;
    for (auto& of_piece : counts_) next += std::exchange(of_piece[cell], next);
  }
  start_[cells] = next;
  team.each(pieces, [&](std::size_t piece) {
    const std::uint32_t end = piece_begin(count, pieces, piece + 1);
    for (std::uint32_t i = piece_begin(count, pieces, piece); i < end; ++i) order_[counts_[piece][cell_of_[i]]++] = i;
  });
  team.each(pieces, [&](std::size_t piece) {
    granules.permute(order_.data(), piece_begin(count, pieces, piece), piece_begin(count, pieces, piece + 1));
  });
  granules.swap_permuted();
}

} // namespace grandamp
