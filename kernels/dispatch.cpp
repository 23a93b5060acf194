#include "kernels/dispatch.hpp"

#include "kernels/candidate_kernel.hpp"
#include "kernels/mixed_instantiation.hpp"

namespace grandamp::kernels {

#define GRANDAMP_DECLARE(set)                                                                                          \
  extern const KernelTable set##_none, set##_energies, set##_ledger, set##_ledger_and_energies;                        \
  extern const MixedTable set##_mixed;                                                                                 \
  extern const SearchTable set##_search;
GRANDAMP_DECLARE(generic)
#ifdef GRANDAMP_HAVE_AVX2
GRANDAMP_DECLARE(avx2)
#endif
#ifdef GRANDAMP_HAVE_AVX512
GRANDAMP_DECLARE(avx512)
#endif
#undef GRANDAMP_DECLARE

namespace {

struct InstructionSetTables {
  const KernelTable* by_observation[4];
  const MixedTable* mixed;
  const SearchTable* search;
};

const InstructionSetTables generic_tables = {
    {&generic_none, &generic_energies, &generic_ledger, &generic_ledger_and_energies}, &generic_mixed, &generic_search};
#ifdef GRANDAMP_HAVE_AVX2
const InstructionSetTables avx2_tables = {
    {&avx2_none, &avx2_energies, &avx2_ledger, &avx2_ledger_and_energies}, &avx2_mixed, &avx2_search};
#endif
#ifdef GRANDAMP_HAVE_AVX512
const InstructionSetTables avx512_tables = {
    {&avx512_none, &avx512_energies, &avx512_ledger, &avx512_ledger_and_energies}, &avx512_mixed, &avx512_search};
#endif

const InstructionSetTables& tables(InstructionSet set) {
  switch (set) {
#ifdef GRANDAMP_HAVE_AVX512
  case InstructionSet::avx512:
    return avx512_tables;
#endif
#ifdef GRANDAMP_HAVE_AVX2
  case InstructionSet::avx2:
    return avx2_tables;
#endif
  default:
    return generic_tables;
  }
}

const KernelTable& table(InstructionSet set, Observation observation) {
  return *tables(set).by_observation[static_cast<int>(observation)];
}

} // namespace

bool available(InstructionSet set) {
  switch (set) {
  case InstructionSet::generic:
    return true;
#ifdef GRANDAMP_HAVE_AVX2
  case InstructionSet::avx2:
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
#ifdef GRANDAMP_HAVE_AVX512
  case InstructionSet::avx512:
    return available(InstructionSet::avx2) && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
#endif
  default:
    return false;
  }
}

InstructionSet best_available() {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
    if (available(set)) return set;
  return InstructionSet::generic;
}

const char* name(InstructionSet set) {
  switch (set) {
  case InstructionSet::avx512:
    return "avx512";
  case InstructionSet::avx2:
    return "avx2";
  default:
    return "generic";
  }
}

PairKernel* pair_kernel_for(InstructionSet set, ContactEffects effects) {
  if (effects.precision == Precision::mixed) {
    if (!has_mixed_kernel(effects)) return nullptr;
    return tables(set).mixed->pair[static_cast<int>(effects.observation)][mixed_set(effects)];
  }
  return table(set, effects.observation).pair[contact_set(effects)];
}
WallKernel* plane_kernel_for(InstructionSet set, ContactEffects effects) {
  return table(set, effects.observation).plane[contact_set(effects)];
}
WallKernel* side_kernel_for(InstructionSet set, ContactEffects effects) {
  return table(set, effects.observation).side[contact_set(effects)];
}
MotionKernel* motion_kernel_for(InstructionSet set, MotionEffects effects) {
  return table(set, effects.observation).motion[motion_set(effects)];
}
CandidateKernel* candidate_kernel_for(InstructionSet set, bool alike) {
  return tables(set).search->candidates[alike ? 1 : 0];
}
CoarseKernel* coarse_kernel_for(InstructionSet set, bool alike) {
  return tables(set).search->coarse[alike ? 1 : 0];
}
SplitKernel* split_kernel_for(InstructionSet set, bool alike) {
  return tables(set).search->split[alike ? 1 : 0];
}

} // namespace grandamp::kernels
