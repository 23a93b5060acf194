#include "kernels/mixed_instantiation.hpp"
#include "kernels/simd_avx2_mixed.hpp"

namespace grandamp::kernels {
extern const MixedTable avx2_mixed;
constinit const MixedTable avx2_mixed = InstantiateMixed<Avx2Mixed>::table();
} // namespace grandamp::kernels
