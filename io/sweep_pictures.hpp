// The pictures of a sweep, and the tables that go with two of them. Internal to io.
#pragma once

#include "io/sweep_table.hpp"

namespace grandamp {

/// Whether the first key is the frequency of a harmonic force: then there is a response.
bool is_response(const SweepTable& table);
/// Whether the first key is how strongly a harmonic motion is driven: then there is a damping curve.
bool is_damping(const SweepTable& table);

/// Writes sweep.svg, dissipation.svg and, where they apply, response.svg and .csv, damping.svg and .csv, and notes the
/// pictures in table.pictures. Throws FileError.
void write_sweep_pictures(SweepTable& table);

} // namespace grandamp
