// The portable instruction set: four lanes of GCC's vector extension, which any target lowers to what it has. No fused
// multiply-add is assumed, so its bits differ from those of AVX2 and AVX-512.
#pragma once

#include "kernels/eight_floats.hpp"

namespace grandamp::kernels {

struct Generic {
  typedef double Vector __attribute__((vector_size(32)));
  typedef long long Mask __attribute__((vector_size(32)));
  using Row = Vector;
  using Double = Generic;
  using Eight = EightFloats;
  static constexpr int width = 4;
  static constexpr double tiny = 1e-200;
  static constexpr int few_marks = 20;
  static constexpr bool stages_apart = false;
  static constexpr bool pairs_by_one_load = false;

  GRANDAMP_INLINE Vector load(const double* p) {
    Vector v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
  }
  GRANDAMP_INLINE void store(double* p, Vector v) { __builtin_memcpy(p, &v, sizeof v); }
  GRANDAMP_INLINE Vector broadcast(double x) { return Vector{x, x, x, x}; }
  GRANDAMP_INLINE Vector fma(Vector a, Vector b, Vector c) { return a * b + c; }
  GRANDAMP_INLINE Vector fnma(Vector a, Vector b, Vector c) { return c - a * b; }
  GRANDAMP_INLINE Vector fnms(Vector a, Vector b, Vector c) { return broadcast(0.0) - c - a * b; }
  GRANDAMP_INLINE Vector sqrt(Vector a) {
    return Vector{__builtin_sqrt(a[0]), __builtin_sqrt(a[1]), __builtin_sqrt(a[2]), __builtin_sqrt(a[3])};
  }
  GRANDAMP_INLINE Vector max(Vector a, Vector b) { return a > b ? a : b; }
  GRANDAMP_INLINE Vector min(Vector a, Vector b) { return a < b ? a : b; }
  GRANDAMP_INLINE Vector abs(Vector a) {
    const Mask magnitude = {0x7fffffffffffffffLL, 0x7fffffffffffffffLL, 0x7fffffffffffffffLL, 0x7fffffffffffffffLL};
    return reinterpret_cast<Vector>(reinterpret_cast<Mask>(a) & magnitude);
  }
  GRANDAMP_INLINE unsigned less(Vector a, Vector b) {
    const Mask m = a < b;
    return static_cast<unsigned>((m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8));
  }

  GRANDAMP_INLINE Row row_load(const double* p) { return load(p); }
  GRANDAMP_INLINE void row_store(double* p, Row r) { store(p, r); }
  GRANDAMP_INLINE Row row_of_floats(const float* p) { return Row{p[0], p[1], p[2], p[3]}; }
  GRANDAMP_INLINE Row row_broadcast(double x) { return broadcast(x); }
  GRANDAMP_INLINE Row row_set(double a, double b, double c, double d) { return Row{a, b, c, d}; }
  GRANDAMP_INLINE Row row_fma(Row a, Row b, Row c) { return a * b + c; }
  GRANDAMP_INLINE Row row_fnma(Row a, Row b, Row c) { return c - a * b; }
  GRANDAMP_INLINE Row row_min(Row a, Row b) { return min(a, b); }
  GRANDAMP_INLINE Row row_with_last(Row row, Row last) { return Row{row[0], row[1], row[2], last[3]}; }

  GRANDAMP_INLINE void columns(const Row (&r)[4], Vector& a, Vector& b, Vector& c, Vector& d) {
    const Vector ab01 = __builtin_shuffle(r[0], r[1], Mask{0, 4, 2, 6});
    const Vector cd01 = __builtin_shuffle(r[0], r[1], Mask{1, 5, 3, 7});
    const Vector ab23 = __builtin_shuffle(r[2], r[3], Mask{0, 4, 2, 6});
    const Vector cd23 = __builtin_shuffle(r[2], r[3], Mask{1, 5, 3, 7});
    a = __builtin_shuffle(ab01, ab23, Mask{0, 1, 4, 5});
    c = __builtin_shuffle(ab01, ab23, Mask{2, 3, 6, 7});
    b = __builtin_shuffle(cd01, cd23, Mask{0, 1, 4, 5});
    d = __builtin_shuffle(cd01, cd23, Mask{2, 3, 6, 7});
  }
  GRANDAMP_INLINE void rows(Vector a, Vector b, Vector c, Vector d, Row (&r)[4]) {
    const Row in[4] = {a, b, c, d};
    columns(in, r[0], r[1], r[2], r[3]);
  }

  GRANDAMP_INLINE unsigned select(const RowPair* from, unsigned mask, RowPair* to) {
    unsigned n = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
      to[n] = from[lane];
      n += (mask >> lane) & 1U;
    }
    return n;
  }
  GRANDAMP_INLINE unsigned select(const std::uint32_t* from, unsigned mask, std::uint32_t* to) {
    unsigned n = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
      to[n] = from[lane];
      n += (mask >> lane) & 1U;
    }
    return n;
  }
  GRANDAMP_INLINE unsigned select_partners(std::uint32_t first, std::uint32_t base, unsigned mask, RowPair* to) {
    unsigned n = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
      to[n] = RowPair::of(first, base + lane);
      n += (mask >> lane) & 1U;
    }
    return n;
  }
};

} // namespace grandamp::kernels
