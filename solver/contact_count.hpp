// How many others, walls included, each granule touches.
#pragma once

#include "solver/granules.hpp"
#include "solver/verlet_list.hpp"
#include "solver/walls.hpp"

#include <cstdint>
#include <vector>

namespace grandamp {

/// By id, from the listed pairs that overlap now.
std::vector<std::int32_t> contacts_by_id(const Granules& granules, const VerletList& list,
                                         const std::vector<Wall>& walls);

} // namespace grandamp
