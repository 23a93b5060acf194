// AVX2 with FMA: four lanes. Arithmetic through xsimd; what it lacks, or does slowly, by hand.
#pragma once

#include "kernels/eight_floats_avx2.hpp"

#include <immintrin.h>
#include <xsimd/xsimd.hpp>

namespace grandamp::kernels {

/// For each of 16 masks, the 32-bit words of the marked 64-bit lanes moved to the front.
alignas(64) inline constexpr std::uint32_t avx2_select_table[16][8] = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {2, 3, 0, 1, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {4, 5, 0, 1, 2, 3, 6, 7}, {0, 1, 4, 5, 2, 3, 6, 7}, {2, 3, 4, 5, 0, 1, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {6, 7, 0, 1, 2, 3, 4, 5}, {0, 1, 6, 7, 2, 3, 4, 5}, {2, 3, 6, 7, 0, 1, 4, 5}, {0, 1, 2, 3, 6, 7, 4, 5},
    {4, 5, 6, 7, 0, 1, 2, 3}, {0, 1, 4, 5, 6, 7, 2, 3}, {2, 3, 4, 5, 6, 7, 0, 1}, {0, 1, 2, 3, 4, 5, 6, 7}};

/// The same for four 32-bit words.
alignas(64) inline constexpr std::uint32_t avx2_select_index_table[16][4] = {
    {0, 1, 2, 3}, {0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 2, 3}, {2, 0, 1, 3}, {0, 2, 1, 3}, {1, 2, 0, 3}, {0, 1, 2, 3},
    {3, 0, 1, 2}, {0, 3, 1, 2}, {1, 3, 0, 2}, {0, 1, 3, 2}, {2, 3, 0, 1}, {0, 2, 3, 1}, {1, 2, 3, 0}, {0, 1, 2, 3}};

struct Avx2 {
  using Vector = xsimd::batch<double, xsimd::fma3<xsimd::avx2>>;
  using Row = Vector;
  using Double = Avx2;
  using Eight = EightFloatsAvx2;
  static constexpr int width = 4;
  static constexpr double tiny = 1e-200;
  static constexpr int few_marks = 20;
  static constexpr bool stages_apart = true;
  static constexpr bool pairs_by_one_load = false;

  GRANDAMP_INLINE Vector load(const double* p) { return _mm256_loadu_pd(p); }
  GRANDAMP_INLINE void store(double* p, Vector v) { _mm256_storeu_pd(p, v); }
  GRANDAMP_INLINE Vector broadcast(double x) { return _mm256_set1_pd(x); }
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return xsimd::fma(a, b, c); }
  GRANDAMP_INLINE Vector fnma(Vector a, Vector b, Vector c) { return xsimd::fnma(a, b, c); }
  GRANDAMP_INLINE Vector fnms(Vector a, Vector b, Vector c) { return _mm256_fnmsub_pd(a, b, c); }
  GRANDAMP_INLINE Vector sqrt(Vector a) { return xsimd::sqrt(a); }
  GRANDAMP_INLINE Vector max(Vector a, Vector b) { return xsimd::max(a, b); }
  GRANDAMP_INLINE Vector min(Vector a, Vector b) { return xsimd::min(a, b); }
  GRANDAMP_INLINE Vector abs(Vector a) { return xsimd::abs(a); }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) {
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_LT_OQ)));
  }

  GRANDAMP_INLINE Row row_load(const double* p) { return _mm256_load_pd(p); }
  GRANDAMP_INLINE void row_store(double* p, Row r) { _mm256_store_pd(p, r); }
  GRANDAMP_INLINE Row row_of_floats(const float* p) { return _mm256_cvtps_pd(_mm_loadu_ps(p)); }
  GRANDAMP_INLINE Row row_broadcast(double x) { return broadcast(x); }
  GRANDAMP_INLINE Row row_set(double a, double b, double c, double d) { return _mm256_setr_pd(a, b, c, d); }
  GRANDAMP_INLINE Row row_fma(Row a, Row b, Row c) { return xsimd::fma(a, b, c); }
  GRANDAMP_INLINE Row row_fnma(Row a, Row b, Row c) { return xsimd::fnma(a, b, c); }
  GRANDAMP_INLINE Row row_min(Row a, Row b) { return xsimd::min(a, b); }
  GRANDAMP_INLINE Row row_with_last(Row row, Row last) { return _mm256_blend_pd(row, last, 8); }

  GRANDAMP_INLINE void columns(const Row (&r)[4], Vector& a, Vector& b, Vector& c, Vector& d) {
    const __m256d ac01 = _mm256_unpacklo_pd(r[0], r[1]);
    const __m256d bd01 = _mm256_unpackhi_pd(r[0], r[1]);
    const __m256d ac23 = _mm256_unpacklo_pd(r[2], r[3]);
    const __m256d bd23 = _mm256_unpackhi_pd(r[2], r[3]);
    a = _mm256_permute2f128_pd(ac01, ac23, 0x20);
    b = _mm256_permute2f128_pd(bd01, bd23, 0x20);
    c = _mm256_permute2f128_pd(ac01, ac23, 0x31);
    d = _mm256_permute2f128_pd(bd01, bd23, 0x31);
  }
  GRANDAMP_INLINE void rows(Vector a, Vector b, Vector c, Vector d, Row (&r)[4]) {
    const Row in[4] = {a, b, c, d};
    columns(in, r[0], r[1], r[2], r[3]);
  }

  GRANDAMP_INLINE unsigned select(const RowPair* from, unsigned mask, RowPair* to) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), together(from, mask));
    return static_cast<unsigned>(__builtin_popcount(mask));
  }
  GRANDAMP_INLINE unsigned select(const std::uint32_t* from, unsigned mask, std::uint32_t* to) {
    const __m128i order = _mm_load_si128(reinterpret_cast<const __m128i*>(avx2_select_index_table[mask]));
    const __m128 values = _mm_loadu_ps(reinterpret_cast<const float*>(from));
    _mm_storeu_ps(reinterpret_cast<float*>(to), _mm_permutevar_ps(values, order));
    return static_cast<unsigned>(__builtin_popcount(mask));
  }
  GRANDAMP_INLINE unsigned select_partners(std::uint32_t first, std::uint32_t base, unsigned mask, RowPair* to) {
    const RowPair pair = RowPair::of(first, base);
    const __m256i partners = _mm256_add_epi64(
        _mm256_set1_epi64x(static_cast<long long>(pair.second_offset) << 32 | pair.first_offset),
        _mm256_setr_epi64x(0, 1LL << (32 + offset_bits), 2LL << (32 + offset_bits), 3LL << (32 + offset_bits)));
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(avx2_select_table[mask]));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(partners, order));
    return static_cast<unsigned>(__builtin_popcount(mask));
  }

private:
  GRANDAMP_INLINE __m256i together(const RowPair* from, unsigned mask) {
    const __m256i pairs = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(avx2_select_table[mask]));
    return _mm256_permutevar8x32_epi32(pairs, order);
  }
};

} // namespace grandamp::kernels
