#include "kernels/candidate_kernel.hpp"
#include "kernels/simd_generic.hpp"

namespace grandamp::kernels {
extern CandidateKernel* const generic_candidates[2];
constinit CandidateKernel* const generic_candidates[2] = {candidate_kernel<Generic, false>,
                                                          candidate_kernel<Generic, true>};
extern SplitKernel* const generic_split[2];
constinit SplitKernel* const generic_split[2] = {split_kernel<Generic, false>, split_kernel<Generic, true>};
} // namespace grandamp::kernels
