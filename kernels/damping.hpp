// Normal damping, as the coefficient of the approach speed d'.
#pragma once

#include "kernels/effects.hpp"
#include "kernels/simd.hpp"

namespace grandamp::kernels {

/// Tsuji (Fang et al. 2007, Eq. 6, with the effective mass): alpha sqrt(m k_n) d^(1/4) = alpha sqrt(m C sqrt(R d)).
/// Linear: c_n.
template <class S, Damping D>
GRANDAMP_INLINE typename S::Vector damping_coefficient(typename S::Vector constant, typename S::Vector mass,
                                                       typename S::Vector C, typename S::Vector root) {
  if constexpr (D == Damping::tsuji || D == Damping::tsuji_without_tension)
    return constant * S::sqrt(mass * (C * root)); // C root is in the spring's force as well
  else
    return constant;
}

} // namespace grandamp::kernels
