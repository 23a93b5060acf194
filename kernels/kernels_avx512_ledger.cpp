#include "kernels/instantiation.hpp"
#include "kernels/simd_avx512.hpp"

namespace grandamp::kernels {
extern const KernelTable avx512_ledger;
constinit const KernelTable avx512_ledger = Instantiate<Avx512, Observation::ledger>::table();
} // namespace grandamp::kernels
