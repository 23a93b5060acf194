// Chooses the kernels of a run once: by instruction set and set of effects.
#pragma once

#include "kernels/arguments.hpp"
#include "kernels/effects.hpp"
#include "kernels/search_arguments.hpp"

namespace grandamp::kernels {

enum class InstructionSet { generic, avx2, avx512 };

/// Built into this binary and run by this machine.
bool available(InstructionSet set);
InstructionSet best_available();
const char* name(InstructionSet set);

/// Null: effects of mixed precision that has_mixed_kernel leaves out.
PairKernel* pair_kernel_for(InstructionSet set, ContactEffects effects);
WallKernel* plane_kernel_for(InstructionSet set, ContactEffects effects);
WallKernel* side_kernel_for(InstructionSet set, ContactEffects effects);
MotionKernel* motion_kernel_for(InstructionSet set, MotionEffects effects);
CandidateKernel* candidate_kernel_for(InstructionSet set, bool alike);
CoarseKernel* coarse_kernel_for(InstructionSet set, bool alike);
SplitKernel* split_kernel_for(InstructionSet set, bool alike);

} // namespace grandamp::kernels
