// The pair kernels of mixed precision, for one instruction set: those that scenes ask for often. What is left out has
// no kernel in float, and a scene that asks for it is refused (kernels/effects.hpp: has_mixed_kernel).
#pragma once

#include "kernels/instantiation.hpp"

#include <utility>

namespace grandamp::kernels {

inline constexpr int mixed_observations = 4;
inline constexpr int mixed_sets = 3 * 3 * 3; ///< damping x friction x variety

constexpr int mixed_set(ContactEffects e) {
  return (static_cast<int>(e.damping) * 3 + static_cast<int>(e.friction)) * 3 + static_cast<int>(e.variety);
}
/// The kernel that serves: granules of one radius under Tsuji's damping, with friction and spin or without any, have
/// their own, several radii the full law; materials serve all else.
constexpr ContactEffects mixed_effects(int set, int observation) {
  ContactEffects e{static_cast<Damping>(set / 9), static_cast<Friction>(set / 3 % 3), static_cast<Variety>(set % 3),
                   static_cast<Observation>(observation), Precision::mixed};
  const bool own = e.damping == Damping::tsuji &&
                   (e.friction == Friction::coulomb || (e.friction == Friction::none && e.variety == Variety::alike));
  const bool elastic = e.damping == Damping::none && e.friction == Friction::none && e.variety == Variety::alike;
  if (!own && !elastic) e.variety = Variety::materials;
  return e;
}

/// By Observation and set.
struct MixedTable {
  PairKernel* pair[mixed_observations][mixed_sets];
};

template <class S> struct InstantiateMixed {
  template <int... numbers> static constexpr MixedTable table(std::integer_sequence<int, numbers...>) {
    MixedTable table{};
    ((table.pair[numbers / mixed_sets][numbers % mixed_sets] =
          pair_kernel<S, mixed_effects(numbers % mixed_sets, numbers / mixed_sets)>),
     ...);
    return table;
  }
  static constexpr MixedTable table() {
    return table(std::make_integer_sequence<int, mixed_observations * mixed_sets>{});
  }
};

} // namespace grandamp::kernels
