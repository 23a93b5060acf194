// Candidate search: granules against contiguous ranges of sorted granules, exactly or in float; and the division of the
// pairs found into classes of gaps.
#pragma once

#include "kernels/search_arguments.hpp"
#include "kernels/simd.hpp"

namespace grandamp::kernels {

/// alike: `reach` holds both radii and the skin.
template <class S, bool alike>
RowPair* candidate_kernel(const CandidateArguments& a, IndexRange own, std::uint32_t own_end, const IndexRange* ranges,
                          int count, RowPair* to) {
  using Vector = typename S::Vector;
  constexpr std::uint32_t width = S::width;
  const Vector reach = S::broadcast(a.reach);
  for (std::uint32_t i = own.first; i < own.last; ++i) {
    const Vector x = S::broadcast(a.x[i]), y = S::broadcast(a.y[i]), z = S::broadcast(a.z[i]);
    Vector radius = reach;
    if constexpr (!alike) radius = S::broadcast(a.radius[i]);
    const auto search = [&](std::uint32_t first, std::uint32_t last) __attribute__((always_inline)) {
      for (std::uint32_t j = first; j < last; j += width) {
        const Vector dx = S::load(a.x + j) - x, dy = S::load(a.y + j) - y, dz = S::load(a.z + j) - z;
        const Vector square = S::fma(dz, dz, S::fma(dy, dy, dx * dx));
        Vector near = reach;
        if constexpr (!alike) near = reach + (S::load(a.radius + j) + radius);
        unsigned mask = S::less(square, near * near);
        if (last - j < width) mask &= (1U << (last - j)) - 1U;
        to += S::select_partners(i, j, mask, to);
      }
    };
    search(i + 1, own_end);
    for (int k = 0; k < count; ++k) search(ranges[k].first, ranges[k].last);
  }
  return to;
}

/// Lays the ranges' coordinates side by side, and behind them what is near nobody, wherever that is; returns how many
/// there are.
template <class S, bool alike>
std::uint32_t bring_together(const CoarseArguments& a, const CoarseScratch& near, IndexRange own, std::uint32_t own_end,
                             const IndexRange* ranges, int count) {
  using F = typename S::Eight;
  std::uint32_t n = 0;
  const auto bring = [&](std::uint32_t first, std::uint32_t last) __attribute__((always_inline)) {
    for (std::uint32_t j = first, to = n; j < last; j += F::width, to += F::width) {
      F::store(near.x + to, F::load(a.x + j));
      F::store(near.y + to, F::load(a.y + j));
      F::store(near.z + to, F::load(a.z + j));
      if constexpr (!alike) F::store(near.radius + to, F::load(a.radius + j));
      F::store_offsets(near.offset + to, j);
    }
    n += last - first;
  };
  if (own_end > own.first) bring(own.first, own_end);
  for (int k = 0; k < count; ++k)
    if (ranges[k].last > ranges[k].first) bring(ranges[k].first, ranges[k].last);
  F::store(near.x + n, F::broadcast(__builtin_nanf("")));
  return n;
}

/// In float, eight at a time. The ranges of a cell are short, so they are brought together first: once for all the
/// granules of the cell.
template <class S, bool alike>
RowPair* coarse_kernel(const CoarseArguments& arguments, IndexRange own, std::uint32_t own_end,
                       const IndexRange* ranges, int count, RowPair* to) {
  using F = typename S::Eight;
  using Vector = typename F::Vector;
  const CoarseArguments a = arguments; // where nothing that is stored can be a part of it
  const CoarseScratch near = a.scratch;
  const std::uint32_t n = bring_together<S, alike>(a, near, own, own_end, ranges, count);
  for (std::uint32_t i = own.first; i < own.last; ++i) {
    const Vector x = F::broadcast(a.x[i]), y = F::broadcast(a.y[i]), z = F::broadcast(a.z[i]);
    const Vector reach = F::broadcast(alike ? a.reach : a.reach + a.radius[i]);
    for (std::uint32_t k = own_end > own.first ? i - own.first + 1 : 0; k < n; k += F::width) {
      const Vector dx = F::load(near.x + k) - x, dy = F::load(near.y + k) - y, dz = F::load(near.z + k) - z;
      const Vector square = F::fma(dz, dz, F::fma(dy, dy, dx * dx));
      Vector limit = reach;
      if constexpr (!alike) limit = limit + F::load(near.radius + k);
      to += F::select_partners(i, near.offset + k, F::less(square, limit * limit), to);
    }
  }
  return to;
}

/// alike: `reach` holds both radii and the gap.
template <class S, bool alike> void split_kernel(const SplitArguments& a, std::size_t (&sizes)[gap_classes]) {
  using Vector = typename S::Vector;
  using Row = typename S::Row;
  constexpr std::size_t width = S::width;
  const Row last_flipped = S::row_set(1.0, 1.0, 1.0, -1.0);
  RowPair* to[gap_classes] = {a.pairs};
  for (std::size_t c = 1; c < gap_classes; ++c) to[c] = a.scratch[c - 1];
  for (std::size_t k = 0; k < a.count; k += width) {
    Row rows[width];
    for (std::size_t lane = 0; lane < width; ++lane) {
      const std::size_t pair = k + lane < a.count ? k + lane : k;
      rows[lane] = S::row_fnma(last_flipped, S::row_load(&row_at(a.position, a.pairs[pair].first_offset).x),
                               S::row_load(&row_at(a.position, a.pairs[pair].second_offset).x));
    }
    Vector x, y, z, radii;
    S::columns(rows, x, y, z, radii);
    const Vector square = S::fma(z, z, S::fma(y, y, x * x));
    unsigned within[gap_classes];
    for (std::size_t c = 0; c < gap_classes; ++c) {
      Vector reach = S::broadcast(a.reach[c]);
      if constexpr (!alike) reach = reach + radii;
      within[c] = S::less(square, reach * reach);
    }
    // The first class last: what it stores may stand where these pairs are read.
    const unsigned listed = a.count - k < width ? (1U << (a.count - k)) - 1U : (1U << width) - 1U;
    for (std::size_t c = gap_classes - 1; c > 0; --c)
      to[c] += S::select(a.pairs + k, within[c] & ~within[c - 1] & listed, to[c]);
    to[0] += S::select(a.pairs + k, within[0] & listed, to[0]);
  }
  sizes[0] = static_cast<std::size_t>(to[0] - a.pairs);
  for (std::size_t c = 1; c < gap_classes; ++c) sizes[c] = static_cast<std::size_t>(to[c] - a.scratch[c - 1]);
}

/// By whether all granules are alike.
struct SearchTable {
  CandidateKernel* candidates[2];
  CoarseKernel* coarse[2];
  SplitKernel* split[2];
};

template <class S> constexpr SearchTable search_table() {
  return {{candidate_kernel<S, false>, candidate_kernel<S, true>},
          {coarse_kernel<S, false>, coarse_kernel<S, true>},
          {split_kernel<S, false>, split_kernel<S, true>}};
}

} // namespace grandamp::kernels
