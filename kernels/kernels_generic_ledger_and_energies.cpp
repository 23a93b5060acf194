#include "kernels/instantiation.hpp"
#include "kernels/simd_generic.hpp"

namespace grandamp::kernels {
extern const KernelTable generic_ledger_and_energies;
constinit const KernelTable generic_ledger_and_energies =
    Instantiate<Generic, Observation::ledger_and_energies>::table();
} // namespace grandamp::kernels
