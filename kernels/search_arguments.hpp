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

/// Room for all granules of the ranges, and 2 list_padding more.
struct CoarseScratch {
  float *x = nullptr, *y = nullptr, *z = nullptr, *radius = nullptr;
  std::uint32_t* offset = nullptr;
};

/// In any unit that makes a cell's length about 1. `reach` has to allow for what float leaves out: the kernel is to
/// find every pair, and some more, which SplitKernel drops.
struct CoarseArguments : SearchArguments<float> {
  CoarseScratch scratch;
};

/// Granules [own.first, own.last) against those after them up to own_end, and against `count` ranges. Appends at `to`
/// (which must have room for every pair tested, and list_padding more) and returns the new end.
template <class Arguments>
using SearchKernel = RowPair*(const Arguments&, IndexRange own, std::uint32_t own_end, const IndexRange* ranges,
                              int count, RowPair* to);
using CandidateKernel = SearchKernel<CandidateArguments>;
using CoarseKernel = SearchKernel<CoarseArguments>;

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
