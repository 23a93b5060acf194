#include "kernels/candidate_kernel.hpp"
#include "kernels/simd_avx2.hpp"

namespace grandamp::kernels {
extern CandidateKernel* const avx2_candidates[2];
constinit CandidateKernel* const avx2_candidates[2] = {candidate_kernel<Avx2, false>, candidate_kernel<Avx2, true>};
extern SplitKernel* const avx2_split[2];
constinit SplitKernel* const avx2_split[2] = {split_kernel<Avx2, false>, split_kernel<Avx2, true>};
} // namespace grandamp::kernels
