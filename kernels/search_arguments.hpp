// What the searches for candidates take and give.
#pragma once

#include "kernels/rows.hpp"

#include <cstddef>
#include <cstdint>

namespace grandamp::kernels {

/// Pairs by the gap between their surfaces when they were listed: two granules that were a quarter of the skin apart
/// cannot touch before both together have come a quarter of the skin nearer. A step tests only the classes that can.
inline constexpr std::size_t gap_classes = 4;

/// Positions as arrays of coordinates, which may be read up to list_padding entries past the last.
template <class Real> struct SearchArguments {
  const Real* x = nullptr;
  const Real* y = nullptr;
  const Real* z = nullptr;
  const Real* radius = nullptr; ///< null if all are alike
  Real reach{};                 ///< skin; alike: both radii and the skin
};

/// In metres; finds exactly the pairs closer than their radii and the skin.
using CandidateArguments = SearchArguments<double>;

/// Of a cell's 13 neighbours that come after it, those that are not in its own row are in these.
inline constexpr int most_rows_beside = 4;

/// Rows of cells along the fastest axis, each told by where its cells begin and where the last ends: `cells` + 1
/// entries.
struct CellRows {
  std::uint32_t cells = 0;
  std::uint32_t first = 0, last = 0; ///< cells whose granules look for partners; one past the last
  const std::uint32_t* own = nullptr;
  bool within = true; ///< pairs within the own row are looked for, too
  int count = 0;
  const std::uint32_t* beside[most_rows_beside] = {};

  /// The cells next to one, and itself: the first, and one past the last.
  constexpr std::uint32_t before(std::uint32_t cell) const { return cell > 0 ? cell - 1 : 0; }
  constexpr std::uint32_t after(std::uint32_t cell) const { return cell + 2 < cells ? cell + 2 : cells; }
};

/// In any unit that makes a cell's length about 1. `reach` has to allow for what float leaves out: the kernel is to
/// find every pair, and some more, which SplitKernel drops.
using CoarseArguments = SearchArguments<float>;

/// Granules [own.first, own.last) against those after them up to own_end, and against `count` ranges. Appends at `to`
/// (which must have room for every pair tested, and list_padding more) and returns the new end.
using CandidateKernel = RowPair*(const CandidateArguments&, IndexRange own, std::uint32_t own_end,
                                 const IndexRange* ranges, int count, RowPair* to);
/// The granules of those cells of the own row, each against those after it in its cell and the next, and those of its
/// cell and both next to it of the rows beside. Appends at `to` (which must have room for every pair tested, and
/// list_padding more) and returns the new end.
using CoarseKernel = RowPair*(const CoarseArguments&, const CellRows&, RowPair* to);

struct SplitArguments {
  const PositionRow* position = nullptr;
  RowPair* pairs = nullptr; ///< room for list_padding more is read and written
  std::size_t count = 0;
  RowPair* scratch[gap_classes - 1] = {}; ///< count + list_padding entries each
  double reach[gap_classes] = {};         ///< rising: gap below which a pair is of the class; alike: and both radii, m
};

/// Divides pairs into classes of gaps, each in the order of before: the first class in place, the others in scratch.
/// Pairs beyond the last reach are dropped. `sizes` gets how many are in each.
using SplitKernel = void(const SplitArguments&, std::size_t (&sizes)[gap_classes]);

} // namespace grandamp::kernels
