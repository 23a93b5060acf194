#include "kernels/instantiation.hpp"
#include "kernels/simd_avx2.hpp"

namespace grandamp::kernels {
extern const KernelTable avx2_ledger_and_energies;
constinit const KernelTable avx2_ledger_and_energies = Instantiate<Avx2, Observation::ledger_and_energies>::table();
} // namespace grandamp::kernels
