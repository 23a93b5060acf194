// AVX2 with FMA, eight lanes of float between rows of double.
#pragma once

#include "kernels/simd_avx2.hpp"

namespace grandamp::kernels {

struct Avx2Mixed {
  using Double = Avx2;
  using Vector = xsimd::batch<float, xsimd::fma3<xsimd::avx2>>;
  using Row = Avx2::Row;
  static constexpr int width = 8;
  static constexpr double tiny = 1e-36;
  static constexpr bool stages_apart = true;

  GRANDAMP_INLINE void store(double* p, Vector v) {
    _mm256_storeu_pd(p, _mm256_cvtps_pd(_mm256_castps256_ps128(v)));
    _mm256_storeu_pd(p + 4, _mm256_cvtps_pd(_mm256_extractf128_ps(v, 1)));
  }
  GRANDAMP_INLINE Vector broadcast(double x) { return _mm256_set1_ps(static_cast<float>(x)); }
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return xsimd::fma(a, b, c); }
  GRANDAMP_INLINE Vector fnma(Vector a, Vector b, Vector c) { return xsimd::fnma(a, b, c); }
  GRANDAMP_INLINE Vector fnms(Vector a, Vector b, Vector c) { return _mm256_fnmsub_ps(a, b, c); }
  GRANDAMP_INLINE Vector sqrt(Vector a) { return xsimd::sqrt(a); }
  GRANDAMP_INLINE Vector max(Vector a, Vector b) { return xsimd::max(a, b); }
  GRANDAMP_INLINE Vector min(Vector a, Vector b) { return xsimd::min(a, b); }
  GRANDAMP_INLINE Vector abs(Vector a) { return xsimd::abs(a); }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
  }
  GRANDAMP_INLINE Vector narrow(const Avx2::Vector (&halves)[2]) {
    return _mm256_set_m128(_mm256_cvtpd_ps(halves[1]), _mm256_cvtpd_ps(halves[0]));
  }

  GRANDAMP_INLINE Row row_load(const double* p) { return Avx2::row_load(p); }
  GRANDAMP_INLINE void row_store(double* p, Row r) { Avx2::row_store(p, r); }
  GRANDAMP_INLINE Row row_set(double a, double b, double c, double d) { return Avx2::row_set(a, b, c, d); }
  GRANDAMP_INLINE Row row_fnma(Row a, Row b, Row c) { return Avx2::row_fnma(a, b, c); }

  GRANDAMP_INLINE void columns(const Row (&r)[8], Vector& a, Vector& b, Vector& c, Vector& d) {
    const __m256 r04 = both(r[0], r[4]), r15 = both(r[1], r[5]), r26 = both(r[2], r[6]), r37 = both(r[3], r[7]);
    __m256 columns[4];
    transpose(r04, r15, r26, r37, columns);
    a = columns[0];
    b = columns[1];
    c = columns[2];
    d = columns[3];
  }
  GRANDAMP_INLINE void rows(Vector a, Vector b, Vector c, Vector d, Row (&r)[8]) {
    __m256 pairs[4]; // rows k and k + 4
    transpose(a, b, c, d, pairs);
    for (int k = 0; k < 4; ++k) {
      r[k] = _mm256_cvtps_pd(_mm256_castps256_ps128(pairs[k]));
      r[k + 4] = _mm256_cvtps_pd(_mm256_extractf128_ps(pairs[k], 1));
    }
  }

private:
  GRANDAMP_INLINE __m256 both(Row low, Row high) {
    return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
  }
  /// Of four by four floats, in either half.
  GRANDAMP_INLINE void transpose(__m256 a, __m256 b, __m256 c, __m256 d, __m256 (&to)[4]) {
    const __m256d ab_low = _mm256_castps_pd(_mm256_unpacklo_ps(a, b)),
                  ab_high = _mm256_castps_pd(_mm256_unpackhi_ps(a, b));
    const __m256d cd_low = _mm256_castps_pd(_mm256_unpacklo_ps(c, d)),
                  cd_high = _mm256_castps_pd(_mm256_unpackhi_ps(c, d));
    to[0] = _mm256_castpd_ps(_mm256_unpacklo_pd(ab_low, cd_low));
    to[1] = _mm256_castpd_ps(_mm256_unpackhi_pd(ab_low, cd_low));
    to[2] = _mm256_castpd_ps(_mm256_unpacklo_pd(ab_high, cd_high));
    to[3] = _mm256_castpd_ps(_mm256_unpackhi_pd(ab_high, cd_high));
  }
};

} // namespace grandamp::kernels
