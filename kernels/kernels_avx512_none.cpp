#include "kernels/instantiation.hpp"
#include "kernels/simd_avx512.hpp"

namespace grandamp::kernels {
extern const KernelTable avx512_none;
constinit const KernelTable avx512_none = Instantiate<Avx512, Observation::none>::table();
} // namespace grandamp::kernels
