// Eight lanes of float, whatever the instruction set: the vocabulary of the coarse search. Portably here, by AVX2 in
// eight_floats_avx2.hpp.
//
//   Vector, width, load and store (unaligned), broadcast, and the operators of the compiler's vector extension
//   of_rows(low, high)                         two rows of four doubles (kernels/simd.hpp)
//   fma(a, b, c) = a b + c                     fused where the instruction set has it
//   less(a, b)                                 one bit per lane
//   select_partners(first, base, mask, to)     the pairs of row `first` and the marked ones of eight rows from `base`;
//                                              returns their number. May write eight.
#pragma once

#include "kernels/simd.hpp"

namespace grandamp::kernels {

struct EightFloats {
  using Vector [[gnu::vector_size(32)]] = float;
  static constexpr std::uint32_t width = 8;

  GRANDAMP_INLINE Vector load(const float* p) {
    Vector v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
  }
  GRANDAMP_INLINE void store(float* p, Vector v) { __builtin_memcpy(p, &v, sizeof v); }
  template <class Row> GRANDAMP_INLINE Vector of_rows(Row low, Row high) {
    Vector v;
    for (int k = 0; k < 4; ++k) {
      v[k] = static_cast<float>(low[k]);
      v[4 + k] = static_cast<float>(high[k]);
    }
    return v;
  }
  GRANDAMP_INLINE Vector broadcast(float x) { return Vector{x, x, x, x, x, x, x, x}; }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) {
    const auto marked = a < b;
    int mask = 0;
    for (unsigned lane = 0; lane < width; ++lane) mask |= marked[lane] & (1 << lane);
    return static_cast<unsigned>(mask);
  }
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return a * b + c; }
  GRANDAMP_INLINE unsigned select_partners(std::uint32_t first, std::uint32_t base, unsigned mask, RowPair* to) {
    unsigned n = 0;
    for (unsigned lane = 0; lane < width; ++lane) {
      to[n] = RowPair::of(first, base + lane);
      n += (mask >> lane) & 1U;
    }
    return n;
  }
};

} // namespace grandamp::kernels
