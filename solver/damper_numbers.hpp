// A damper in the numbers that its users quote.
#pragma once

#include "solver/plan.hpp"

namespace grandamp {

DamperNumbers damper_numbers(const Scene& scene);

} // namespace grandamp
