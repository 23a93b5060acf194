// Coulomb friction, regularised by the impulse that would stop the slip (Fang et al. 2007, Eq. 7).
#pragma once

#include "kernels/simd.hpp"

namespace grandamp::kernels {

/// g in f_t = -g v_t: mu |F_n| / |v_t|, at most `cap` = c m_t / dt, so that one step cannot reverse the slip. At zero
/// slip the quotient is huge and the cap holds. c is the lesser friction_share of the two granules: stopping one slip
/// alone takes m_t v_t^2 / 2, no more than its granules' kinetic energy, so all of a granule's contacts together make
/// no energy as long as c <= 2/n, n the contacts that it has now.
template <class S>
GRANDAMP_INLINE typename S::Vector coulomb_coefficient(typename S::Vector mu, typename S::Vector normal_force,
                                                       typename S::Vector slip_squared, typename S::Vector cap) {
  // The tiny square keeps 0/0 out; its root is far below any speed. The division waits neither for the root nor for the
  // normal force.
  const typename S::Vector square = slip_squared + S::broadcast(S::tiny);
  return S::min(mu * S::abs(normal_force) * (S::broadcast(1.0) / square * S::sqrt(square)), cap);
}

/// The friction_share of granules that had n contacts a step ago: 1/(1 + n), or 1/2 if none. Passive as long as n does
/// not more than double, and grow by two, in a step.
template <class S> GRANDAMP_INLINE typename S::Vector friction_share(typename S::Vector touching) {
  const typename S::Vector one = S::broadcast(1.0);
  return one / (one + S::max(touching, one));
}

} // namespace grandamp::kernels
