// Eight lanes of float by AVX2; for AVX-512 too, where ranges are too short for more.
#pragma once

#include "kernels/eight_floats.hpp"

#include <immintrin.h>

namespace grandamp::kernels {

/// For each of 256 masks the marked lanes in turn, in the order that unpacking in halves wants: 0 1 4 5 2 3 6 7. A row
/// is eight bytes.
struct EightSelectTable {
  std::uint64_t row[256];
};
constexpr EightSelectTable make_eight_select_table() {
  constexpr unsigned place[8] = {0, 1, 4, 5, 2, 3, 6, 7}; // of the n-th marked lane
  EightSelectTable table{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    unsigned n = 0;
    for (unsigned lane = 0; lane < 8; ++lane)
      if ((mask >> lane & 1U) != 0) table.row[mask] |= std::uint64_t{lane} << 8 * place[n++];
  }
  return table;
}
alignas(64) inline constexpr EightSelectTable eight_select_table = make_eight_select_table();

struct EightFloatsAvx2 {
  using Vector [[gnu::vector_size(32)]] = float;
  static constexpr std::uint32_t width = 8;

  GRANDAMP_INLINE Vector load(const float* p) { return _mm256_loadu_ps(p); }
  GRANDAMP_INLINE void store(float* p, Vector v) { _mm256_storeu_ps(p, v); }
  GRANDAMP_INLINE Vector of_rows(__m256d low, __m256d high) {
    return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
  }
  GRANDAMP_INLINE Vector broadcast(float x) { return _mm256_set1_ps(x); }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
  }
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return _mm256_fmadd_ps(a, b, c); }
  GRANDAMP_INLINE unsigned select_partners(std::uint32_t first, std::uint32_t base, unsigned mask, RowPair* to) {
    const __m256i firsts = _mm256_set1_epi32(static_cast<int>(first << offset_bits));
    const __m256i lanes =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(eight_select_table.row + mask)));
    const __m256i partners = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(base << offset_bits)),
                                              _mm256_slli_epi32(lanes, offset_bits));
    const auto found = static_cast<unsigned>(__builtin_popcount(mask));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_unpacklo_epi32(firsts, partners));
    if (found > 4) _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + 4), _mm256_unpackhi_epi32(firsts, partners));
    return found;
  }
};

} // namespace grandamp::kernels
