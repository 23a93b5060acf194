// Hertz: F = k_n d^(3/2), k_n = C sqrt(R) (Fang et al. 2007, Eqs. 2, 4, 5).
#pragma once

#include "kernels/simd.hpp"

namespace grandamp::kernels {

/// sqrt(R d): the one root that force and damping share.
template <class S>
GRANDAMP_INLINE typename S::Vector hertz_root(typename S::Vector radius, typename S::Vector overlap) {
  return S::sqrt(radius * overlap);
}

/// k_n d^(3/2) = (C sqrt(R d)) d; damping_coefficient() needs the product in brackets as well.
template <class S>
GRANDAMP_INLINE typename S::Vector hertz_force(typename S::Vector C, typename S::Vector root,
                                               typename S::Vector overlap) {
  return C * root * overlap;
}

/// Energy of the spring, 2/5 k_n d^(5/2) = 2/5 F d.
template <class S>
GRANDAMP_INLINE typename S::Vector hertz_energy(typename S::Vector force, typename S::Vector overlap) {
  return S::broadcast(0.4) * force * overlap;
}

} // namespace grandamp::kernels
