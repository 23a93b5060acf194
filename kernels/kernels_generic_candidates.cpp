#include "kernels/candidate_kernel.hpp"
#include "kernels/simd_generic.hpp"

namespace grandamp::kernels {
extern const SearchTable generic_search;
constinit const SearchTable generic_search = search_table<Generic>();
} // namespace grandamp::kernels
