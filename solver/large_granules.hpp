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
  /// Takes note of those beyond small_radius; granules are sorted by the grid.
  void find(const Granules& granules, double small_radius);

  /// All pairs closer than their radii and the skin of which one at least is large, whose first row is of the segment
  /// and whose second comes before next_end, where the next segment ends: no pair reaches further. Sorted.
  void list_pairs(const LargeSearch& search, const CellGrid& grid, const Granules& granules,
                  kernels::IndexRange segment, std::uint32_t next_end, std::vector<kernels::RowPair>& pairs) const;

private:
  std::vector<std::uint32_t> rows_; ///< rising
};

} // namespace grandamp
