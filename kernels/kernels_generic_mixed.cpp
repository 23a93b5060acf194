#include "kernels/mixed_instantiation.hpp"
#include "kernels/simd_generic_mixed.hpp"

namespace grandamp::kernels {
extern const MixedTable generic_mixed;
constinit const MixedTable generic_mixed = InstantiateMixed<GenericMixed>::table();
} // namespace grandamp::kernels
