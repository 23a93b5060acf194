// Candidate search: one cell's granules against contiguous ranges of sorted granules; and the division of the pairs
// found into near and far ones.
#pragma once

#include "kernels/arguments.hpp"

namespace grandamp::kernels {

/// alike: `reach` holds both radii and the skin.
template <class S, bool alike>
RowPair* candidate_kernel(const CandidateArguments& a, IndexRange own, std::uint32_t own_end, const IndexRange* ranges,
                          int count, RowPair* to) {
  using Vector = typename S::Vector;
  constexpr std::uint32_t width = S::width;
  for (std::uint32_t i = own.first; i < own.last; ++i) {
    const Vector x = S::broadcast(a.x[i]), y = S::broadcast(a.y[i]), z = S::broadcast(a.z[i]);
    Vector reach = S::broadcast(a.reach);
    if constexpr (!alike) reach = reach + S::broadcast(a.radius[i]);
    const auto search = [&](std::uint32_t first, std::uint32_t last) __attribute__((always_inline)) {
      for (std::uint32_t j = first; j < last; j += width) {
        const Vector dx = S::load(a.x + j) - x, dy = S::load(a.y + j) - y, dz = S::load(a.z + j) - z;
        const Vector square = S::fma(dz, dz, S::fma(dy, dy, dx * dx));
        Vector near = reach;
        if constexpr (!alike) near = near + S::load(a.radius + j);
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

/// alike: `reach` holds both radii and the gap.
template <class S, bool alike> std::size_t split_kernel(const SplitArguments& a) {
  using Vector = typename S::Vector;
  using Row = typename S::Row;
  constexpr std::size_t width = S::width;
  const Row last_flipped = S::row_set(1.0, 1.0, 1.0, -1.0);
  const Vector reach = S::broadcast(a.reach);
  std::size_t near = 0, far = 0;
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
    const Vector limit = alike ? reach : reach + radii;
    const unsigned listed = a.count - k < width ? (1U << (a.count - k)) - 1U : (1U << width) - 1U;
    const unsigned is_near = S::less(square, limit * limit) & listed;
    far += S::select(a.pairs + k, ~is_near & listed, a.scratch + far);
    near += S::select(a.pairs + k, is_near, a.pairs + near);
  }
  for (std::size_t k = 0; k < far; ++k) a.pairs[near + k] = a.scratch[k];
  return near;
}

} // namespace grandamp::kernels
