// Candidate search: granules against contiguous ranges of sorted granules, exactly, or against the cells around theirs,
// in float; and the division of the pairs found into classes of gaps.
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

/// In float, eight at a time. Three cells of a row hold a few granules: one vector, as a rule, of which what is past
/// them is masked. No cells at all take one vector, too, so that no branch depends on how many there are up to eight.
/// alike: `reach` holds both radii and the skin.
template <class S, bool alike>
RowPair* coarse_kernel(const CoarseArguments& arguments, const CellRows& cell_rows, RowPair* to) {
  using F = typename S::Eight;
  using Vector = typename F::Vector;
  const CoarseArguments a = arguments; // where nothing that is stored can be a part of it
  const CellRows rows = cell_rows;
  for (std::uint32_t cell = rows.first; cell < rows.last; ++cell) {
    const std::uint32_t before = rows.before(cell), after = rows.after(cell);
    IndexRange beside[most_rows_beside];
    for (int k = 0; k < rows.count; ++k) beside[k] = {rows.beside[k][before], rows.beside[k][after]};
    for (std::uint32_t i = rows.own[cell]; i < rows.own[cell + 1]; ++i) {
      const Vector x = F::broadcast(a.x[i]), y = F::broadcast(a.y[i]), z = F::broadcast(a.z[i]);
      const Vector reach = F::broadcast(alike ? a.reach : a.reach + a.radius[i]);
      const auto look = [&](std::uint32_t j, std::uint32_t last) __attribute__((always_inline)) {
        do {
          const Vector dx = F::load(a.x + j) - x, dy = F::load(a.y + j) - y, dz = F::load(a.z + j) - z;
          const Vector square = F::fma(dz, dz, F::fma(dy, dy, dx * dx));
          Vector limit = reach;
          if constexpr (!alike) limit = limit + F::load(a.radius + j);
          const std::uint32_t left = last - j;
          const unsigned listed = (1U << (left < F::width ? left : F::width)) - 1U;
          to += F::select_partners(i, j, F::less(square, limit * limit) & listed, to);
          j += F::width;
        } while (j < last);
      };
      if (rows.within) look(i + 1, rows.own[after]);
      for (int k = 0; k < rows.count; ++k) look(beside[k].first, beside[k].last);
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
