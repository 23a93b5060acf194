// Coulomb friction, regularised by the impulse that would stop the slip (Fang et al. 2007, Eq. 7).
#pragma once

#include "kernels/simd.hpp"

namespace grandamp::kernels {

/// g in f_t = -g v_t: mu |F_n| / |v_t|, at most `cap` = c m_t / dt, so that one step cannot reverse the slip. At zero
/// slip the quotient is huge and the cap holds.
template <class S>
GRANDAMP_INLINE typename S::Vector coulomb_coefficient(typename S::Vector mu, typename S::Vector normal_force,
                                                       typename S::Vector slip_squared, typename S::Vector cap) {
  const typename S::Vector tiny = S::broadcast(S::tiny); // keeps 0/0 out; its root is far below any speed
  // The division need not wait for the normal force.
  return S::min(mu * S::abs(normal_force) * (S::broadcast(1.0) / S::sqrt(slip_squared + tiny)), cap);
}

} // namespace grandamp::kernels
