// The vector vocabulary of the kernels. Each instruction set is a struct with the same static functions, in a file of
// its own (simd_generic.hpp, simd_avx2.hpp, simd_avx512.hpp); the kernels are templates over it. Every operation is
// lane by lane and every sum over lanes is taken in the order of the list, so the bits do not depend on the lane count.
//
// An instruction set S offers
//   S::Vector, S::width             lanes of double
//   S::Row                          one row of four doubles
//   S::Double                       the set that works in double: S itself, but for the mixed sets
//   S::Eight                        eight lanes of float (kernels/eight_floats.hpp)
//   S::tiny                         a square far below any speed's or force's that is not zero
//   S::few_marks                    up to which, of 64, marked entries are moved one by one (kernels/contact_loops.hpp)
//   S::stages_apart                 whether contacts are worked off in three loops (kernels/contact_loops.hpp)
//   S::pairs_by_one_load            whether a candidate's two offsets are loaded together (kernels/pair_kernel.hpp)
//   load, store, broadcast          unaligned
//   fma(a, b, c) = a b + c, fnma(a, b, c) = c - a b   (fused where the instruction set has it)
//   fnms(a, b, c) = -c - a b        fused as those
//   sqrt, max, min, abs
//   less(a, b)                      one bit per lane
//   row_load, row_store, row_broadcast, row_fma, row_fnma, row_min, row_set
//   row_of_floats                   of four floats, unaligned
//   row_with_last(row, last)        three of the one, the fourth of the other
//   columns(rows, a, b, c, d)       transposes `width` rows into four vectors
//   rows(a, b, c, d, rows)          and back
//   select(from, mask, to)          moves the marked ones of `width` list entries together; returns their number.
//                                   Reads and writes `width` entries.
//   select_partners(first, base, mask, to)   the pairs (first, base + lane) of the marked lanes
//
// A mixed set (simd_..._mixed.hpp) has lanes of float, twice as many, and rows of double all the same: columns and rows
// convert on the way, broadcast and store take and give double. It has no load and no select; and
//   narrow(halves)                  two vectors of double into one of float
#pragma once

#include "kernels/rows.hpp"

#include <cstdint>

#define GRANDAMP_INLINE [[gnu::always_inline]] static inline
