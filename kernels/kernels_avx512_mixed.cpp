#include "kernels/mixed_instantiation.hpp"
#include "kernels/simd_avx512_mixed.hpp"

namespace grandamp::kernels {
extern const MixedTable avx512_mixed;
constinit const MixedTable avx512_mixed = InstantiateMixed<Avx512Mixed>::table();
} // namespace grandamp::kernels
