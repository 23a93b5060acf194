#include "kernels/instantiation.hpp"
#include "kernels/simd_avx2.hpp"

namespace grandamp::kernels {
extern const KernelTable avx2_energies;
constinit const KernelTable avx2_energies = Instantiate<Avx2, Observation::energies>::table();
} // namespace grandamp::kernels
