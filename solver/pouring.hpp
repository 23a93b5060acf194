// Granules poured and brought to rest, before t = 0.
#pragma once

#include "kernels/dispatch.hpp"
#include "solver/packing.hpp"
#include "solver/plan.hpp"
#include "solver/simulation.hpp"

#include <functional>

namespace grandamp {

/// Lets the granules fall under the scene's gravity in the still enclosure until their mean kinetic energy is below
/// 1e-6 of m g d, and replaces their positions by those of rest. `so_far`, if given, is the state of an earlier pouring
/// of the same scene, which goes on by the same bits. Throws GuardError if they come to no rest, StateError.
void pour(const Plan& plan, Placement& placement, kernels::InstructionSet isa, int threads,
          const std::function<void(const PouringProgress&)>& progress, const RunState* so_far = nullptr);

} // namespace grandamp
