// What is wrong with a scene: everything that a file's reader, or a program that fills in a Scene, may have let
// through.
#pragma once

#include "solver/errors.hpp"
#include "solver/scene.hpp"

#include <vector>

namespace grandamp {

/// Every fault of the scene, with its key; empty if it can be planned. Where explicit positions are is left to the
/// packing, contact constants to make_contact_table.
std::vector<Problem> faults_of(const Scene& scene);

} // namespace grandamp
