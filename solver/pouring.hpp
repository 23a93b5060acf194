// Granules poured and brought to rest, before t = 0.
#pragma once

#include "kernels/dispatch.hpp"
#include "solver/packing.hpp"
#include "solver/plan.hpp"

#include <functional>

namespace grandamp {

/// Lets the granules fall under the scene's gravity in the still enclosure until their mean kinetic energy is below
/// 1e-6 of m g d, and replaces their positions by those of rest. Throws GuardError if they come to no rest.
void pour(const Plan& plan, Placement& placement, kernels::InstructionSet isa, int threads,
          const std::function<void(double, double)>& progress);

} // namespace grandamp
