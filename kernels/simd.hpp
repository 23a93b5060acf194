// The vector vocabulary of the kernels. Each instruction set is a struct with the same static functions, in a file of
// its own (simd_generic.hpp, simd_avx2.hpp, simd_avx512.hpp); the kernels are templates over it. Every operation is
// lane by lane and every sum over lanes is taken in the order of the list, so the bits do not depend on the lane count.
//
// An instruction set S offers
//   S::Vector, S::width             lanes of double
//   S::Row                          one row of four doubles
//   load, store, broadcast          unaligned
//   fma(a, b, c) = a b + c, fnma(a, b, c) = c - a b   (fused where the instruction set has it)
//   sqrt, max, min, abs
//   less(a, b)                      one bit per lane
//   row_load, row_store, row_broadcast, row_fma, row_fnma, row_set
//   columns(rows, a, b, c, d)       transposes `width` rows into four vectors
//   rows(a, b, c, d, rows)          and back
//   select(from, mask, to)          moves the marked ones of `width` list entries together; returns their number.
//                                   Reads and writes `width` entries.
//   select_partners(first, base, mask, to)   the pairs (first, base + lane) of the marked lanes
#pragma once

#include "kernels/rows.hpp"

#include <cstdint>

#define GRANDAMP_INLINE [[gnu::always_inline]] static inline
