// Sums of Chebyshev polynomials.
#pragma once

#include <array>
#include <cstddef>

namespace grandamp {

/// Sum over k of c_k T_k(x) for x from -1 to 1, by Clenshaw's recurrence (C. W. Clenshaw, Math. Tables Aids Comput. 9
/// (1955) 118-120).
template <std::size_t terms> double chebyshev_sum(const std::array<double, terms>& coefficient, double x) {
  double next = 0.0, after_next = 0.0;
  for (std::size_t k = terms; k-- > 1;) {
    const double here = 2.0 * x * next - after_next + coefficient[k];
    after_next = next;
    next = here;
  }
  return x * next - after_next + coefficient[0];
}

} // namespace grandamp
