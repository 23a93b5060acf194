// Rows of 64 bytes, which hold two rows of four: velocity and spin with the inverses of mass and radius.
#pragma once

#include "kernels/simd.hpp"

namespace grandamp::kernels {

/// As two rows; AVX-512 holds one in a register (kernels/lines_avx512.hpp).
template <class S> struct Lines {
  using D = typename S::Double;
  using Row = typename S::Row;
  using Vector = typename S::Vector;
  static constexpr int width = S::width;
  struct Line {
    Row low, high;
  };

  GRANDAMP_INLINE Line of(Row low, Row high) { return {low, high}; }
  GRANDAMP_INLINE Line load(const double* p) { return {D::row_load(p), D::row_load(p + 4)}; }
  GRANDAMP_INLINE void store(double* p, Line line) {
    D::row_store(p, line.low);
    D::row_store(p + 4, line.high);
  }
  GRANDAMP_INLINE Row low(Line line) { return line.low; }
  GRANDAMP_INLINE Row high(Line line) { return line.high; }
  GRANDAMP_INLINE Line scaled(double by, Line line) {
    const Row factor = D::row_broadcast(by);
    return {factor * line.low, factor * line.high};
  }
  /// The first row with another added to it, the second as it is.
  GRANDAMP_INLINE Line with_low_plus(Line line, Row row) { return {line.low + row, line.high}; }
  /// a b + c
  GRANDAMP_INLINE Line fma(Line a, Line b, Line c) {
    return {D::row_fma(a.low, b.low, c.low), D::row_fma(a.high, b.high, c.high)};
  }
  /// Lines of zeros that each end in one of the lanes.
  GRANDAMP_INLINE void last_of_lines(Vector last, Line (&to)[width]) {
    const Vector zero = S::broadcast(0.0);
    Row rows[width];
    S::rows(zero, zero, zero, last, rows);
    for (int lane = 0; lane < width; ++lane) to[lane] = {D::row_broadcast(0.0), rows[lane]};
  }
  /// Transposes `width` lines into eight vectors.
  GRANDAMP_INLINE void columns(const Line (&lines)[width], Vector (&to)[8]) {
    Row rows[width];
    for (int lane = 0; lane < width; ++lane) rows[lane] = lines[lane].low;
    S::columns(rows, to[0], to[1], to[2], to[3]);
    for (int lane = 0; lane < width; ++lane) rows[lane] = lines[lane].high;
    S::columns(rows, to[4], to[5], to[6], to[7]);
  }
};

} // namespace grandamp::kernels
