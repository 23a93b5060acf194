// A Verlet list as plain arrays, and back: what a checkpoint holds of it, so that a run that goes on need not build it
// anew and tests the same pairs in the same order. Whoever changes Segment changes these two functions.
#pragma once

#include "solver/run_state.hpp"
#include "solver/verlet_list.hpp"

namespace grandamp {

/// `ghost`: the number of granules, which marks the padding; that is left out.
ListState state_of(const VerletList& list, std::uint32_t ghost);

/// Throws StateError if the arrays are none of a list of `granules` rows and `walls` walls.
void restore(VerletList& list, const ListState& state, std::uint32_t granules, std::size_t walls);

} // namespace grandamp
