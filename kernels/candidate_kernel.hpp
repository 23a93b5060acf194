// Candidate search: one cell's granules against contiguous ranges of sorted granules.
#pragma once

#include "kernels/arguments.hpp"

namespace grandamp::kernels {

/// alike: `reach` holds both radii and the skin.
template <class S, bool alike>
CandidatePair* candidate_kernel(const CandidateArguments& a, IndexRange own, std::uint32_t own_end,
                                const IndexRange* ranges, int count, CandidatePair* to) {
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

} // namespace grandamp::kernels
