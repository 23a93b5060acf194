// Granules that are larger than the grid's cells allow for: few, and looked for one by one. The grid finds the pairs of
// the others.
#pragma once

#include "kernels/search_arguments.hpp"
#include "solver/cell_grid.hpp"

#include <cstdint>
#include <vector>

namespace grandamp {

/// What a search for pairs of large granules needs to know.
struct LargeSearch {
  kernels::CandidateKernel* kernel = nullptr;
  kernels::CandidateArguments coordinates; ///< of all granules, in m
  double small_radius = 0.0;               ///< up to which granules are in cells of their size, m
  double largest_radius = 0.0;             ///< m
  double skin = 0.0;                       ///< m
};

class LargeGranules {
public:
  void clear() noexcept { rows_.clear(); }
  bool any() const noexcept { return !rows_.empty(); }
  /// Rows of some more, rising.
  void add(const std::vector<std::uint32_t>& rows) { rows_.insert(rows_.end(), rows.begin(), rows.end()); }
  /// Into cells of their own size, in a box of `size`, once all are there.
  void sort(const Granules& granules, const Vector3& size, const LargeSearch& search);

  /// All pairs closer than their radii and the skin of which one at least is large, whose first row is of the segment
  /// and whose second comes before next_end, where the next segment ends: no pair reaches further. Sorted.
  void list_pairs(const LargeSearch& search, const CellGrid& grid, const Granules& granules,
                  kernels::IndexRange segment, std::uint32_t next_end, std::vector<kernels::RowPair>& pairs) const;

private:
  void list_with_large(const LargeSearch& search, const Granules& granules, std::uint32_t row, std::uint32_t next_end,
                       std::vector<kernels::RowPair>& pairs) const;

  std::vector<std::uint32_t> rows_; ///< rising
  /// Cells of their own size, for the pairs among them: the first place of each cell in by_cell_, and the end.
  GridShape shape_;
  std::vector<std::uint32_t> start_;
  std::vector<std::uint32_t> by_cell_; ///< rows, by cell
};

} // namespace grandamp
