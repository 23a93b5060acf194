// Tables of kernels over every set of effects, for one instruction set. Included by the ten-line files kernels_*.cpp,
// each of which instantiates the kernels of one Observation.
#pragma once

#include "kernels/candidate_kernel.hpp"
#include "kernels/effects.hpp"
#include "kernels/motion_kernel.hpp"
#include "kernels/pair_kernel.hpp"
#include "kernels/wall_kernel.hpp"

#include <utility>

namespace grandamp::kernels {

inline constexpr int contact_sets = 27; ///< damping x friction x variety
inline constexpr int motion_sets = 8;   ///< integration x rotates x accelerated

constexpr int contact_set(ContactEffects e) {
  return (static_cast<int>(e.damping) * 3 + static_cast<int>(e.friction)) * 3 + static_cast<int>(e.variety);
}
constexpr ContactEffects contact_effects(int set, Observation observation) {
  return {static_cast<Damping>(set / 9), static_cast<Friction>(set / 3 % 3), static_cast<Variety>(set % 3),
          observation};
}
constexpr int motion_set(MotionEffects e) {
  return static_cast<int>(e.integration) * 4 + (e.rotates ? 2 : 0) + (e.accelerated ? 1 : 0);
}
constexpr MotionEffects motion_effects(int set, Observation observation) {
  return {static_cast<Integration>(set / 4), (set & 2) != 0, (set & 1) != 0, observation};
}

/// The kernels of one instruction set and one Observation.
struct KernelTable {
  PairKernel* pair[contact_sets];
  WallKernel* plane[contact_sets];
  WallKernel* side[contact_sets];
  MotionKernel* motion[motion_sets];
};

template <class S, Observation observation> struct Instantiate {
  template <int... contact, int... motion>
  static constexpr KernelTable table(std::integer_sequence<int, contact...>, std::integer_sequence<int, motion...>) {
    return {{pair_kernel<S, contact_effects(contact, observation)>...},
            {wall_kernel<S, contact_effects(contact, observation), Surface::plane>...},
            {wall_kernel<S, contact_effects(contact, observation), Surface::side>...},
            {motion_kernel<S, motion_effects(motion, observation)>...}};
  }
  static constexpr KernelTable table() {
    return table(std::make_integer_sequence<int, contact_sets>{}, std::make_integer_sequence<int, motion_sets>{});
  }
};

} // namespace grandamp::kernels
