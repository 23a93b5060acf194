// Friction with a memory: a tangential spring k_t sqrt(d) and a dashpot c_t beside it, both behind a slider that holds
// mu |F_n|. Written as f = -k_t sqrt(d) s it would make energy when the overlap d grows at a fixed s. So the force
// takes up k_t sqrt(d) ds while d grows, and shrinks with sqrt(d) while d shrinks: its energy f^2 / (2 k_t sqrt(d))
// then rises by nothing but work.
#pragma once

#include "kernels/simd.hpp"

namespace grandamp::kernels {

/// Constants of a tangential spring, as a row.
struct alignas(32) SpringLawRow {
  double stiffness; ///< C_t in k_t = C_t sqrt(R), N/m^2
  double damping;   ///< c_t, N s/m
  double unused[2];
};

/// A contact's spring: its force on granule i, and sqrt(R d) when it had that force; all zero in a fresh contact.
template <class S> struct Spring { typename S::Vector fx, fy, fz, root; };

/// The spring of the last step, turned into the plane across the normal n without loss of length, and eased to the
/// overlap if that has shrunk.
template <class S>
GRANDAMP_INLINE void turn_and_ease(Spring<S>& spring, typename S::Vector nx, typename S::Vector ny,
                                   typename S::Vector nz, typename S::Vector root) {
  using Vector = typename S::Vector;
  const Vector tiny = S::broadcast(1e-200), one = S::broadcast(1.0);
  const Vector along = S::fma(spring.fz, nz, S::fma(spring.fy, ny, spring.fx * nx));
  const Vector tx = S::fnma(along, nx, spring.fx), ty = S::fnma(along, ny, spring.fy),
               tz = S::fnma(along, nz, spring.fz);
  const Vector before = S::fma(spring.fz, spring.fz, S::fma(spring.fy, spring.fy, spring.fx * spring.fx));
  const Vector after = S::fma(tz, tz, S::fma(ty, ty, tx * tx));
  // min(NaN, 1) is 1: a fresh contact that only just touches.
  const Vector scale = S::sqrt(before / (after + tiny)) * S::min(root / spring.root, one);
  spring.fx = scale * tx;
  spring.fy = scale * ty;
  spring.fz = scale * tz;
}

/// Scale that brings a force of this square down to `most`, if it is larger.
template <class S> GRANDAMP_INLINE typename S::Vector held_at(typename S::Vector most, typename S::Vector square) {
  return S::min(most / S::sqrt(square + S::broadcast(1e-200)), S::broadcast(1.0));
}

/// How long the contact has been there in this step: all of it, or in a fresh one since the overlap was none.
template <class S>
GRANDAMP_INLINE typename S::Vector loading_time(typename S::Vector root_before, typename S::Vector overlap,
                                                typename S::Vector closing, typename S::Vector time_step) {
  const typename S::Vector since = overlap / S::max(closing, S::broadcast(1e-200));
  return S::min(S::fma(root_before, S::broadcast(1e250), since), time_step);
}

/// Energy of the spring, f^2 / (2 C_t sqrt(R d)).
template <class S>
GRANDAMP_INLINE typename S::Vector spring_energy(const Spring<S>& spring, typename S::Vector stiffness) {
  const typename S::Vector square = S::fma(spring.fz, spring.fz, S::fma(spring.fy, spring.fy, spring.fx * spring.fx));
  return S::broadcast(0.5) * square / S::max(stiffness * spring.root, S::broadcast(1e-200));
}

} // namespace grandamp::kernels
