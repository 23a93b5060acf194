#include "kernels/instantiation.hpp"
#include "kernels/simd_avx2.hpp"

namespace grandamp::kernels {
extern const KernelTable avx2_ledger;
constinit const KernelTable avx2_ledger = Instantiate<Avx2, Observation::ledger>::table();
} // namespace grandamp::kernels
