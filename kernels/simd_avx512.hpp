// AVX-512 (F, DQ, VL, BW): eight lanes for the law, rows of four as in AVX2, so that both give the same bits.
#pragma once

#include "kernels/eight_floats_avx2.hpp"
#include "kernels/lines_avx512.hpp"

#include <immintrin.h>
#include <xsimd/xsimd.hpp>

namespace grandamp::kernels {

/// Eight lanes of float: AVX2's, but for masks, which are registers of their own here.
struct EightFloatsAvx512 : EightFloatsAvx2 {
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) { return _mm256_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  GRANDAMP_INLINE unsigned select_partners(std::uint32_t first, std::uint32_t base, unsigned mask, RowPair* to) {
    constexpr long long next = 1LL << (32 + offset_bits);
    const __m512i lanes = _mm512_setr_epi64(0, next, 2 * next, 3 * next, 4 * next, 5 * next, 6 * next, 7 * next);
    const RowPair pair = RowPair::of(first, base);
    const __m512i partners = _mm512_add_epi64(
        _mm512_set1_epi64(static_cast<long long>(pair.second_offset) << 32 | pair.first_offset), lanes);
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi64(static_cast<__mmask8>(mask), partners));
    return static_cast<unsigned>(__builtin_popcount(mask));
  }
};

struct Avx512 {
  using Vector = xsimd::batch<double, xsimd::avx512dq>;
  using Row = xsimd::batch<double, xsimd::fma3<xsimd::avx2>>;
  using Double = Avx512;
  using Eight = EightFloatsAvx512;
  static constexpr int width = 8;
  static constexpr double tiny = 1e-200;
  static constexpr int few_marks = 8;
  static constexpr bool stages_apart = true;
  static constexpr bool pairs_by_one_load = true;

  GRANDAMP_INLINE Vector load(const double* p) { return _mm512_loadu_pd(p); }
  GRANDAMP_INLINE void store(double* p, Vector v) { _mm512_storeu_pd(p, v); }
  GRANDAMP_INLINE Vector broadcast(double x) { return _mm512_set1_pd(x); }
  // xsimd 8.1 does not fuse on AVX-512.
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return _mm512_fmadd_pd(a, b, c); }
  GRANDAMP_INLINE Vector fnma(Vector a, Vector b, Vector c) { return _mm512_fnmadd_pd(a, b, c); }
  GRANDAMP_INLINE Vector fnms(Vector a, Vector b, Vector c) { return _mm512_fnmsub_pd(a, b, c); }
  GRANDAMP_INLINE Vector sqrt(Vector a) { return xsimd::sqrt(a); }
  GRANDAMP_INLINE Vector max(Vector a, Vector b) { return xsimd::max(a, b); }
  GRANDAMP_INLINE Vector min(Vector a, Vector b) { return xsimd::min(a, b); }
  GRANDAMP_INLINE Vector abs(Vector a) { return xsimd::abs(a); }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }

  GRANDAMP_INLINE Row row_load(const double* p) { return _mm256_load_pd(p); }
  GRANDAMP_INLINE void row_store(double* p, Row r) { _mm256_store_pd(p, r); }
  GRANDAMP_INLINE Row row_of_floats(const float* p) { return _mm256_cvtps_pd(_mm_loadu_ps(p)); }
  GRANDAMP_INLINE Row row_broadcast(double x) { return _mm256_set1_pd(x); }
  GRANDAMP_INLINE Row row_set(double a, double b, double c, double d) { return _mm256_setr_pd(a, b, c, d); }
  GRANDAMP_INLINE Row row_fma(Row a, Row b, Row c) { return xsimd::fma(a, b, c); }
  GRANDAMP_INLINE Row row_fnma(Row a, Row b, Row c) { return xsimd::fnma(a, b, c); }
  GRANDAMP_INLINE Row row_min(Row a, Row b) { return xsimd::min(a, b); }
  GRANDAMP_INLINE Row row_with_last(Row row, Row last) { return _mm256_blend_pd(row, last, 8); }

  GRANDAMP_INLINE void columns(const Row (&r)[8], Vector& a, Vector& b, Vector& c, Vector& d) {
    const __m512d r04 = joined(r[0], r[4]), r15 = joined(r[1], r[5]);
    const __m512d r26 = joined(r[2], r[6]), r37 = joined(r[3], r[7]);
    const __m512d ac01 = _mm512_unpacklo_pd(r04, r15), bd01 = _mm512_unpackhi_pd(r04, r15);
    const __m512d ac23 = _mm512_unpacklo_pd(r26, r37), bd23 = _mm512_unpackhi_pd(r26, r37);
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    const __m512i high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    a = _mm512_permutex2var_pd(ac01, low, ac23);
    b = _mm512_permutex2var_pd(bd01, low, bd23);
    c = _mm512_permutex2var_pd(ac01, high, ac23);
    d = _mm512_permutex2var_pd(bd01, high, bd23);
  }
  GRANDAMP_INLINE void rows(Vector a, Vector b, Vector c, Vector d, Row (&r)[8]) {
    const __m512d ab_low = _mm512_unpacklo_pd(a, b), ab_high = _mm512_unpackhi_pd(a, b); // rows 0 2 4 6 | 1 3 5 7
    const __m512d cd_low = _mm512_unpacklo_pd(c, d), cd_high = _mm512_unpackhi_pd(c, d);
    const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    const __m512i second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    const __m512d r04 = _mm512_permutex2var_pd(ab_low, first, cd_low);
    const __m512d r26 = _mm512_permutex2var_pd(ab_low, second, cd_low);
    const __m512d r15 = _mm512_permutex2var_pd(ab_high, first, cd_high);
    const __m512d r37 = _mm512_permutex2var_pd(ab_high, second, cd_high);
    r[0] = _mm512_castpd512_pd256(r04);
    r[1] = _mm512_castpd512_pd256(r15);
    r[2] = _mm512_castpd512_pd256(r26);
    r[3] = _mm512_castpd512_pd256(r37);
    r[4] = _mm512_extractf64x4_pd(r04, 1);
    r[5] = _mm512_extractf64x4_pd(r15, 1);
    r[6] = _mm512_extractf64x4_pd(r26, 1);
    r[7] = _mm512_extractf64x4_pd(r37, 1);
  }

  // What is not marked stays as it was: filled with zeros instead, a Zen 5 waits for what the register held before.
  GRANDAMP_INLINE unsigned select(const RowPair* from, unsigned mask, RowPair* to) {
    const __m512i pairs = _mm512_loadu_si512(from);
    _mm512_storeu_si512(to, _mm512_mask_compress_epi64(pairs, static_cast<__mmask8>(mask), pairs));
    return static_cast<unsigned>(__builtin_popcount(mask));
  }
  GRANDAMP_INLINE unsigned select(const std::uint32_t* from, unsigned mask, std::uint32_t* to) {
    const __m256i values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                        _mm256_mask_compress_epi32(values, static_cast<__mmask8>(mask), values));
    return static_cast<unsigned>(__builtin_popcount(mask));
  }
  GRANDAMP_INLINE unsigned select_partners(std::uint32_t first, std::uint32_t base, unsigned mask, RowPair* to) {
    return Eight::select_partners(first, base, mask, to);
  }

private:
  GRANDAMP_INLINE __m512d joined(Row low, Row high) { return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1); }
};

} // namespace grandamp::kernels
