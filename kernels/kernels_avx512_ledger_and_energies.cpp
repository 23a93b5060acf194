#include "kernels/instantiation.hpp"
#include "kernels/simd_avx512.hpp"

namespace grandamp::kernels {
extern const KernelTable avx512_ledger_and_energies;
constinit const KernelTable avx512_ledger_and_energies = Instantiate<Avx512, Observation::ledger_and_energies>::table();
} // namespace grandamp::kernels
