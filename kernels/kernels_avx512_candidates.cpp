#include "kernels/candidate_kernel.hpp"
#include "kernels/simd_avx512.hpp"

namespace grandamp::kernels {
extern CandidateKernel* const avx512_candidates[2];
constinit CandidateKernel* const avx512_candidates[2] = {candidate_kernel<Avx512, false>,
                                                         candidate_kernel<Avx512, true>};
extern SplitKernel* const avx512_split[2];
constinit SplitKernel* const avx512_split[2] = {split_kernel<Avx512, false>, split_kernel<Avx512, true>};
} // namespace grandamp::kernels
