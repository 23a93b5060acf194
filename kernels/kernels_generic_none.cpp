#include "kernels/instantiation.hpp"
#include "kernels/simd_generic.hpp"

namespace grandamp::kernels {
extern const KernelTable generic_none;
constinit const KernelTable generic_none = Instantiate<Generic, Observation::none>::table();
} // namespace grandamp::kernels
