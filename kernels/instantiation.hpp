// Tables of kernels over every set of effects, for one instruction set. Included by the ten-line files kernels_*.cpp,
// each of which instantiates the kernels of one Observation.
#pragma once

#include "kernels/effects.hpp"
#include "kernels/motion_kernel.hpp"
#include "kernels/pair_kernel.hpp"
#include "kernels/wall_kernel.hpp"

#include <utility>

namespace grandamp::kernels {

inline constexpr int contact_sets = 75; ///< damping x friction x variety
inline constexpr int motion_sets = 12;  ///< integration x rubbing x accelerated

constexpr int contact_set(ContactEffects e) {
  return (static_cast<int>(e.damping) * 5 + static_cast<int>(e.friction)) * 3 + static_cast<int>(e.variety);
}
constexpr ContactEffects contact_effects(int set, Observation observation) {
  return {static_cast<Damping>(set / 15), static_cast<Friction>(set / 3 % 5), static_cast<Variety>(set % 3),
          observation};
}

// A kernel for granules of all kinds serves those that are alike, too. Laws that few scenes call for have no kernels of
// their own for each variety: the build would take twice as long.

constexpr bool rare(ContactEffects e) {
  if (e.damping == Damping::linear_without_tension || e.friction == Friction::spring_without_rotation) return true;
  if (e.only_pushes()) return e.friction == Friction::none || e.friction == Friction::coulomb_without_rotation;
  return e.remembers() && !e.damped();
}
/// The kernel that serves pairs with these effects.
constexpr ContactEffects pair_effects(ContactEffects e) {
  const bool middle = e.variety == Variety::sizes && (e.only_pushes() || e.remembers());
  if (rare(e) || middle) e.variety = Variety::materials;
  return e;
}
/// Of walls: these kernels do not gain by granules that are alike.
constexpr ContactEffects wall_effects(ContactEffects e) {
  e.variety = rare(e) || e.only_pushes() || e.remembers() || e.variety == Variety::materials ? Variety::materials
                                                                                             : Variety::sizes;
  return e;
}
constexpr int motion_set(MotionEffects e) {
  return (static_cast<int>(e.integration) * 3 + static_cast<int>(e.rubbing)) * 2 + (e.accelerated ? 1 : 0);
}
constexpr MotionEffects motion_effects(int set, Observation observation) {
  return {static_cast<Integration>(set / 6), static_cast<Rubbing>(set / 2 % 3), (set & 1) != 0, observation};
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
    return {{pair_kernel<S, pair_effects(contact_effects(contact, observation))>...},
            {wall_kernel<S, wall_effects(contact_effects(contact, observation)), Surface::plane>...},
            {wall_kernel<S, wall_effects(contact_effects(contact, observation)), Surface::side>...},
            {motion_kernel<S, motion_effects(motion, observation)>...}};
  }
  static constexpr KernelTable table() {
    return table(std::make_integer_sequence<int, contact_sets>{}, std::make_integer_sequence<int, motion_sets>{});
  }
};

} // namespace grandamp::kernels
