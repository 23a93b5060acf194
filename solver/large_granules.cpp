#include "solver/large_granules.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace grandamp {

namespace {

using kernels::IndexRange;
using kernels::PositionRow;
using kernels::RowPair;

/// The first and the last cell along each axis of the grid.
using CellBox = std::array<std::array<int, 2>, 3>;

/// The cells that lie within `reach` of the centre, in part.
CellBox cells_within(const GridShape& shape, const PositionRow& row, double reach) {
  const double rounded = 1.000001 * reach;
  CellBox box{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double centre = (&row.x)[shape.axis[k]];
    box[k] = {shape.cell_along(centre - rounded, k), shape.cell_along(centre + rounded, k)};
  }
  return box;
}

/// Rows of those cells, as far as they lie within `rows`.
void ranges_of(const CellGrid& grid, const CellBox& box, IndexRange rows, std::vector<IndexRange>& ranges) {
  const auto& [fast, middle, slow] = box;
  ranges.clear();
  for (int s = slow[0]; s <= slow[1]; ++s)
    for (int m = middle[0]; m <= middle[1]; ++m) {
      const std::uint32_t* const cells = grid.row_start(m, s);
      const IndexRange range{std::max(cells[fast[0]], rows.first), std::min(cells[fast[1] + 1], rows.last)};
      if (range.first < range.last) ranges.push_back(range);
    }
}

} // namespace

void LargeGranules::sort(const Granules& granules, const Vector3& size, const LargeSearch& search) {
  shape_ = make_grid_shape(size, 2.0 * search.largest_radius + search.skin, rows_.size());
  const auto cell_of = [&](std::uint32_t row) { return shape_.cell_of(granules.position[row]); };
  start_.assign(shape_.total() + 1, 0);
  for (const std::uint32_t row : rows_) ++start_[cell_of(row) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  by_cell_.resize(rows_.size());
  for (const std::uint32_t row : rows_) by_cell_[next[cell_of(row)]++] = row;
}

void LargeGranules::list_with_large(const LargeSearch& search, const Granules& granules, std::uint32_t i,
                                    std::uint32_t next_end, std::vector<RowPair>& pairs) const {
  const PositionRow& here = granules.position[i];
  const auto [fast, middle, slow] = cells_within(shape_, here, here.radius + search.largest_radius + search.skin);
  for (int s = slow[0]; s <= slow[1]; ++s)
    for (int m = middle[0]; m <= middle[1]; ++m)
      for (std::uint32_t k = start_[shape_.index(fast[0], m, s)]; k < start_[shape_.index(fast[1], m, s) + 1]; ++k) {
        const std::uint32_t j = by_cell_[k];
        if (j <= i || j >= next_end) continue;
        const PositionRow& there = granules.position[j];
        const double x = there.x - here.x, y = there.y - here.y, z = there.z - here.z;
        // A little more than what belongs to the list; what does not is dropped with the others' pairs.
        const double near = 1.000001 * (here.radius + there.radius + search.skin);
        if (x * x + y * y + z * z < near * near) pairs.push_back(RowPair::of(i, j));
      }
}

void LargeGranules::list_pairs(const LargeSearch& search, const CellGrid& grid, const Granules& granules,
                               IndexRange segment, std::uint32_t next_end, std::vector<RowPair>& pairs) const {
  pairs.clear();
  std::vector<IndexRange> ranges;
  std::vector<RowPair> found;
  const auto begin = std::lower_bound(rows_.begin(), rows_.end(), segment.first);
  const auto end = std::lower_bound(begin, rows_.end(), next_end);
  for (auto large = begin; large != end; ++large) {
    const std::uint32_t i = *large;
    const PositionRow& here = granules.position[i];
    const bool own = i < segment.last;
    const CellBox box = cells_within(grid.shape(), here, here.radius + search.small_radius + search.skin);
    const auto lowest_layer = box[2][0];
    if (!own && grid.layer_start(lowest_layer) >= segment.last) continue;
    ranges_of(grid, box, own ? IndexRange{segment.first, next_end} : segment, ranges);
    std::size_t room = kernels::list_padding;
    for (const IndexRange& range : ranges) room += range.last - range.first;
    if (found.size() < room) found.resize(room);
    const RowPair* const last = search.kernel(search.coordinates, {i, i + 1}, i + 1, ranges.data(),
                                              static_cast<int>(ranges.size()), found.data());
    for (const RowPair* pair = found.data(); pair < last; ++pair) {
      const std::uint32_t j = pair->second();
      if (granules.position[j].radius <= search.small_radius)
        pairs.push_back(RowPair::of(std::min(i, j), std::max(i, j)));
    }
    if (own) list_with_large(search, granules, i, next_end, pairs);
  }
  std::sort(pairs.begin(), pairs.end(), [](const RowPair& a, const RowPair& b) {
    return a.first_offset != b.first_offset ? a.first_offset < b.first_offset : a.second_offset < b.second_offset;
  });
}

} // namespace grandamp
