// The tangential springs of contacts in touch: a row beside every entry of the list, and across rebuilds, sorts and
// checkpoints a table of contacts by the granules' ids. Scenes without springs have none of it.
#pragma once

#include "solver/granules.hpp"
#include "solver/team.hpp"
#include "solver/verlet_list.hpp"

#include <cstdint>
#include <vector>

namespace grandamp {

/// A spring that is loaded: between granule `id` and, with a larger number, another one, or wall w as granules + w.
struct LoadedSpring {
  std::uint32_t id = 0;
  std::uint32_t partner = 0;
  kernels::SpringRow row; ///< the force on `id`
};

class SpringMemory {
public:
  /// Rows of one list of pairs or of one wall.
  struct Rows {
    std::vector<kernels::SpringRow> row;
    std::vector<std::uint32_t> touched;
    void reset(std::size_t entries);
  };
  struct SegmentRows {
    Rows inner, boundary;
    std::vector<Rows> walls;
    std::vector<std::uint32_t> slots; ///< scratch of the sweep
  };

  /// Contacts touched at step `step` are those in touch; what they hold, in the list's order.
  std::vector<LoadedSpring> loaded(const VerletList& list, const Granules& granules, std::int64_t step,
                                   const Team& team) const;
  /// Rows for a list: those of `springs`, as touched at step `step`, all others fresh.
  void spread(const std::vector<LoadedSpring>& springs, const VerletList& list, const Granules& granules,
              std::int64_t step, const Team& team);

  /// For the kernels at step `step`: rows of a list from its entry `first` on.
  static kernels::SpringArguments arguments(Rows& rows, std::vector<std::uint32_t>& slots, std::size_t first,
                                            std::int64_t step);
  SegmentRows& of(std::size_t segment) { return segments_[segment]; }

private:
  std::vector<SegmentRows> segments_;
};

} // namespace grandamp
