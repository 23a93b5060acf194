#include "kernels/candidate_kernel.hpp"
#include "kernels/simd_avx512.hpp"

namespace grandamp::kernels {
extern const SearchTable avx512_search;
constinit const SearchTable avx512_search = search_table<Avx512>();
} // namespace grandamp::kernels
