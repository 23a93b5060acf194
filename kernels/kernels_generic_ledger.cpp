#include "kernels/instantiation.hpp"
#include "kernels/simd_generic.hpp"

namespace grandamp::kernels {
extern const KernelTable generic_ledger;
constinit const KernelTable generic_ledger = Instantiate<Generic, Observation::ledger>::table();
} // namespace grandamp::kernels
