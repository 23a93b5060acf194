// AVX-512, sixteen lanes of float between rows of double.
#pragma once

#include "kernels/simd_avx512.hpp"

namespace grandamp::kernels {

struct Avx512Mixed {
  using Double = Avx512;
  using Vector = xsimd::batch<float, xsimd::avx512dq>;
  using Row = Avx512::Row;
  static constexpr int width = 16;
  static constexpr double tiny = 1e-36;
  static constexpr bool stages_apart = true;

  GRANDAMP_INLINE void store(double* p, Vector v) {
    _mm512_storeu_pd(p, _mm512_cvtps_pd(_mm512_castps512_ps256(v)));
    _mm512_storeu_pd(p + 8, _mm512_cvtps_pd(_mm512_extractf32x8_ps(v, 1)));
  }
  GRANDAMP_INLINE Vector broadcast(double x) { return _mm512_set1_ps(static_cast<float>(x)); }
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return _mm512_fmadd_ps(a, b, c); }
  GRANDAMP_INLINE Vector fnma(Vector a, Vector b, Vector c) { return _mm512_fnmadd_ps(a, b, c); }
  GRANDAMP_INLINE Vector fnms(Vector a, Vector b, Vector c) { return _mm512_fnmsub_ps(a, b, c); }
  GRANDAMP_INLINE Vector sqrt(Vector a) { return _mm512_sqrt_ps(a); }
  GRANDAMP_INLINE Vector max(Vector a, Vector b) { return _mm512_max_ps(a, b); }
  GRANDAMP_INLINE Vector min(Vector a, Vector b) { return _mm512_min_ps(a, b); }
  GRANDAMP_INLINE Vector abs(Vector a) { return _mm512_abs_ps(a); }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  GRANDAMP_INLINE Vector narrow(const Avx512::Vector (&halves)[2]) {
    return joined(_mm512_cvtpd_ps(halves[0]), _mm512_cvtpd_ps(halves[1]));
  }

  GRANDAMP_INLINE Row row_load(const double* p) { return Avx512::row_load(p); }
  GRANDAMP_INLINE void row_store(double* p, Row r) { Avx512::row_store(p, r); }
  GRANDAMP_INLINE Row row_set(double a, double b, double c, double d) { return Avx512::row_set(a, b, c, d); }
  GRANDAMP_INLINE Row row_fnma(Row a, Row b, Row c) { return Avx512::row_fnma(a, b, c); }

  GRANDAMP_INLINE void columns(const Row (&r)[16], Vector& a, Vector& b, Vector& c, Vector& d) {
    __m512 quarters[4], columns[4]; // rows k, k + 4, k + 8, k + 12
    for (int k = 0; k < 4; ++k) quarters[k] = joined(both(r[k], r[4 + k]), both(r[8 + k], r[12 + k]));
    transpose(quarters[0], quarters[1], quarters[2], quarters[3], columns);
    a = columns[0];
    b = columns[1];
    c = columns[2];
    d = columns[3];
  }
  GRANDAMP_INLINE void rows(Vector a, Vector b, Vector c, Vector d, Row (&r)[16]) {
    __m512 quarters[4];
    transpose(a, b, c, d, quarters);
    for (int k = 0; k < 4; ++k) {
      const __m512d low = _mm512_cvtps_pd(_mm512_castps512_ps256(quarters[k]));
      const __m512d high = _mm512_cvtps_pd(_mm512_extractf32x8_ps(quarters[k], 1));
      r[k] = _mm512_castpd512_pd256(low);
      r[k + 4] = _mm512_extractf64x4_pd(low, 1);
      r[k + 8] = _mm512_castpd512_pd256(high);
      r[k + 12] = _mm512_extractf64x4_pd(high, 1);
    }
  }

private:
  GRANDAMP_INLINE __m256 both(Row low, Row high) {
    return _mm512_cvtpd_ps(_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1));
  }
  GRANDAMP_INLINE __m512 joined(__m256 low, __m256 high) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
  }
  /// Of four by four floats, in each quarter.
  GRANDAMP_INLINE void transpose(__m512 a, __m512 b, __m512 c, __m512 d, __m512 (&to)[4]) {
    const __m512d ab_low = _mm512_castps_pd(_mm512_unpacklo_ps(a, b)),
                  ab_high = _mm512_castps_pd(_mm512_unpackhi_ps(a, b));
    const __m512d cd_low = _mm512_castps_pd(_mm512_unpacklo_ps(c, d)),
                  cd_high = _mm512_castps_pd(_mm512_unpackhi_ps(c, d));
    to[0] = _mm512_castpd_ps(_mm512_unpacklo_pd(ab_low, cd_low));
    to[1] = _mm512_castpd_ps(_mm512_unpackhi_pd(ab_low, cd_low));
    to[2] = _mm512_castpd_ps(_mm512_unpacklo_pd(ab_high, cd_high));
    to[3] = _mm512_castpd_ps(_mm512_unpackhi_pd(ab_high, cd_high));
  }
};

} // namespace grandamp::kernels
