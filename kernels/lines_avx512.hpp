// Rows of 64 bytes in AVX-512: one register each.
#pragma once

#include "kernels/lines.hpp"

#include <immintrin.h>

// GCC 12 takes the undefined pass-through operands inside its own AVX-512 header for a mistake of ours, here and in
// simd_avx512.hpp.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"

namespace grandamp::kernels {

struct Avx512;

template <> struct Lines<Avx512> {
  using Line = __m512d;

  GRANDAMP_INLINE Line of(__m256d low, __m256d high) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
  }
  GRANDAMP_INLINE Line load(const double* p) { return _mm512_load_pd(p); }
  GRANDAMP_INLINE void store(double* p, Line line) { _mm512_store_pd(p, line); }
  GRANDAMP_INLINE __m256d low(Line line) { return _mm512_castpd512_pd256(line); }
  GRANDAMP_INLINE __m256d high(Line line) { return _mm512_extractf64x4_pd(line, 1); }
  GRANDAMP_INLINE Line scaled(double by, Line line) { return _mm512_mul_pd(_mm512_set1_pd(by), line); }
  GRANDAMP_INLINE Line with_low_plus(Line line, __m256d row) {
    return _mm512_mask_add_pd(line, 0x0f, line, _mm512_castpd256_pd512(row));
  }
  GRANDAMP_INLINE Line fma(Line a, Line b, Line c) { return _mm512_fmadd_pd(a, b, c); }
  GRANDAMP_INLINE void last_of_lines(__m512d last, Line (&to)[8]) {
    const __m512i lanes = _mm512_castpd_si512(last);
    const auto as_line = [](__m512i v) { return _mm512_castsi512_pd(v); };
    // Turned until the lane wanted is the last, which alone is kept.
    to[0] = as_line(_mm512_maskz_alignr_epi64(0x80, lanes, lanes, 1));
    to[1] = as_line(_mm512_maskz_alignr_epi64(0x80, lanes, lanes, 2));
    to[2] = as_line(_mm512_maskz_alignr_epi64(0x80, lanes, lanes, 3));
    to[3] = as_line(_mm512_maskz_alignr_epi64(0x80, lanes, lanes, 4));
    to[4] = as_line(_mm512_maskz_alignr_epi64(0x80, lanes, lanes, 5));
    to[5] = as_line(_mm512_maskz_alignr_epi64(0x80, lanes, lanes, 6));
    to[6] = as_line(_mm512_maskz_alignr_epi64(0x80, lanes, lanes, 7));
    to[7] = as_line(_mm512_maskz_mov_epi64(0x80, lanes));
  }
  template <class Vector> GRANDAMP_INLINE void columns(const Line (&r)[8], Vector (&to)[8]) {
    __m512d pairs[8], fours[8];
    for (int k = 0; k < 8; k += 2) {
      pairs[k] = _mm512_unpacklo_pd(r[k], r[k + 1]);
      pairs[k + 1] = _mm512_unpackhi_pd(r[k], r[k + 1]);
    }
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    const __m512i high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    for (int first = 0; first < 8; first += 4)
      for (int k = first; k < first + 2; ++k) { // of four lines: columns 0 and 4, 1 and 5, 2 and 6, 3 and 7
        fours[k] = _mm512_permutex2var_pd(pairs[k], low, pairs[k + 2]);
        fours[k + 2] = _mm512_permutex2var_pd(pairs[k], high, pairs[k + 2]);
      }
    for (int k = 0; k < 4; ++k) {
      to[k] = _mm512_shuffle_f64x2(fours[k], fours[k + 4], 0x44);
      to[k + 4] = _mm512_shuffle_f64x2(fours[k], fours[k + 4], 0xee);
    }
  }
};

} // namespace grandamp::kernels
