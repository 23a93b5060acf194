#include "kernels/instantiation.hpp"
#include "kernels/simd_avx512.hpp"

namespace grandamp::kernels {
extern const KernelTable avx512_energies;
constinit const KernelTable avx512_energies = Instantiate<Avx512, Observation::energies>::table();
} // namespace grandamp::kernels
