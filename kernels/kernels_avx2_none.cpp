#include "kernels/instantiation.hpp"
#include "kernels/simd_avx2.hpp"

namespace grandamp::kernels {
extern const KernelTable avx2_none;
constinit const KernelTable avx2_none = Instantiate<Avx2, Observation::none>::table();
} // namespace grandamp::kernels
