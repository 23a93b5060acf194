#include "solver/large_granules.hpp"

#include <algorithm>
#include <array>

namespace grandamp {

namespace {

using kernels::IndexRange;
using kernels::PositionRow;
using kernels::RowPair;

/// Cells along the grid's axis k where granules within `reach` of the centre can be: the first and the last.
std::array<int, 2> cells_within(const CellGrid& grid, const PositionRow& row, double reach, std::size_t k) {
  const double rounded = 1.000001 * reach;
  const double centre = (&row.x)[grid.shape().axis[k]];
  return {grid.shape().cell_along(centre - rounded, k), grid.shape().cell_along(centre + rounded, k)};
}

/// Rows of cells around a granule, as far as they lie within `rows`.
void ranges_around(const CellGrid& grid, const PositionRow& row, double reach, IndexRange rows,
                   std::vector<IndexRange>& ranges) {
  const std::array<int, 2> fast = cells_within(grid, row, reach, 0), middle = cells_within(grid, row, reach, 1),
                           slow = cells_within(grid, row, reach, 2);
  ranges.clear();
  for (int s = slow[0]; s <= slow[1]; ++s)
    for (int m = middle[0]; m <= middle[1]; ++m) {
      const std::uint32_t* const cells = grid.row_start(m, s);
      const IndexRange range{std::max(cells[fast[0]], rows.first), std::min(cells[fast[1] + 1], rows.last)};
      if (range.first < range.last) ranges.push_back(range);
    }
}

} // namespace

void LargeGranules::find(const Granules& granules, double small_radius) {
  rows_.clear();
  for (std::uint32_t i = 0; i < granules.count(); ++i)
    if (granules.position[i].radius > small_radius) rows_.push_back(i);
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
    ranges_around(grid, here, here.radius + search.small_radius + search.skin,
                  own ? IndexRange{segment.first, next_end} : segment, ranges);
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
    if (!own) continue;
    const int top = cells_within(grid, here, here.radius + search.largest_radius + search.skin, 2)[1];
    const std::uint32_t beyond = std::min(next_end, grid.layer_start(top + 1));
    for (auto other = large + 1; other != end && *other < beyond; ++other) {
      const PositionRow& there = granules.position[*other];
      const double x = there.x - here.x, y = there.y - here.y, z = there.z - here.z;
      // A little more than what belongs to the list; what does not is dropped with the others' pairs.
      const double reach = 1.000001 * (here.radius + there.radius + search.skin);
      if (x * x + y * y + z * z < reach * reach) pairs.push_back(RowPair::of(i, *other));
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const RowPair& a, const RowPair& b) {
    return a.first_offset != b.first_offset ? a.first_offset < b.first_offset : a.second_offset < b.second_offset;
  });
}

} // namespace grandamp
