// The portable instruction set, eight lanes of float between rows of double.
#pragma once

#include "kernels/simd_generic.hpp"

namespace grandamp::kernels {

struct GenericMixed {
  using Double = Generic;
  typedef float Vector __attribute__((vector_size(32)));
  typedef int Mask __attribute__((vector_size(32)));
  using Row = Generic::Row;
  static constexpr int width = 8;
  static constexpr double tiny = 1e-36;
  static constexpr bool stages_apart = true;

  GRANDAMP_INLINE void store(double* p, Vector v) {
    for (int lane = 0; lane < 8; ++lane) p[lane] = static_cast<double>(v[lane]);
  }
  GRANDAMP_INLINE Vector broadcast(double x) {
    const float f = static_cast<float>(x);
    return Vector{f, f, f, f, f, f, f, f};
  }
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return a * b + c; }
  GRANDAMP_INLINE Vector fnma(Vector a, Vector b, Vector c) { return c - a * b; }
  GRANDAMP_INLINE Vector fnms(Vector a, Vector b, Vector c) { return broadcast(0.0) - c - a * b; }
  GRANDAMP_INLINE Vector sqrt(Vector a) {
    return Vector{__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]), __builtin_sqrtf(a[3]),
                  __builtin_sqrtf(a[4]), __builtin_sqrtf(a[5]), __builtin_sqrtf(a[6]), __builtin_sqrtf(a[7])};
  }
  GRANDAMP_INLINE Vector max(Vector a, Vector b) { return a > b ? a : b; }
  GRANDAMP_INLINE Vector min(Vector a, Vector b) { return a < b ? a : b; }
  GRANDAMP_INLINE Vector abs(Vector a) {
    const int m = 0x7fffffff;
    return reinterpret_cast<Vector>(reinterpret_cast<Mask>(a) & Mask{m, m, m, m, m, m, m, m});
  }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) {
    const Mask m = a < b;
    unsigned bits = 0;
    for (int lane = 0; lane < 8; ++lane) bits |= static_cast<unsigned>(m[lane] & 1) << lane;
    return bits;
  }
  GRANDAMP_INLINE Vector narrow(const Generic::Vector (&halves)[2]) {
    return __builtin_shuffle(wide(halves[0]), wide(halves[1]), Mask{0, 1, 2, 3, 8, 9, 10, 11});
  }

  GRANDAMP_INLINE Row row_load(const double* p) { return Generic::row_load(p); }
  GRANDAMP_INLINE void row_store(double* p, Row r) { Generic::row_store(p, r); }
  GRANDAMP_INLINE Row row_set(double a, double b, double c, double d) { return Generic::row_set(a, b, c, d); }
  GRANDAMP_INLINE Row row_fnma(Row a, Row b, Row c) { return Generic::row_fnma(a, b, c); }

  GRANDAMP_INLINE void columns(const Row (&r)[8], Vector& a, Vector& b, Vector& c, Vector& d) {
    Vector of[4];
    for (int lane = 0; lane < 8; ++lane)
      for (int k = 0; k < 4; ++k) of[k][lane] = static_cast<float>(r[lane][k]);
    a = of[0];
    b = of[1];
    c = of[2];
    d = of[3];
  }
  GRANDAMP_INLINE void rows(Vector a, Vector b, Vector c, Vector d, Row (&r)[8]) {
    for (int lane = 0; lane < 8; ++lane)
      r[lane] = Row{static_cast<double>(a[lane]), static_cast<double>(b[lane]), static_cast<double>(c[lane]),
                    static_cast<double>(d[lane])};
  }

private:
  GRANDAMP_INLINE Vector wide(Generic::Vector v) {
    return Vector{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
                  static_cast<float>(v[3])};
  }
};

} // namespace grandamp::kernels
