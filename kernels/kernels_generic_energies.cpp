#include "kernels/instantiation.hpp"
#include "kernels/simd_generic.hpp"

namespace grandamp::kernels {
extern const KernelTable generic_energies;
constinit const KernelTable generic_energies = Instantiate<Generic, Observation::energies>::table();
} // namespace grandamp::kernels
