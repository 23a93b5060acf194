#include "kernels/candidate_kernel.hpp"
#include "kernels/simd_avx2.hpp"

namespace grandamp::kernels {
extern const SearchTable avx2_search;
constinit const SearchTable avx2_search = search_table<Avx2>();
} // namespace grandamp::kernels
