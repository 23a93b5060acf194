// The scenes of the hard cases. `whole`: as long and as large as the case asks; otherwise a form for every day.
#pragma once

#include "tests/hard_cases/choices.hpp"
#include "tests/support/scenes.hpp"

#include <vector>

namespace grandamp::test {

/// 150 granules at rest in a cube, which jerks to 5 m/s.
Scene jerked_gas(std::uint64_t seed, bool whole);
/// Table 5's granules on the floor, with the spaces of their lattice, the box jerking to 5 m/s sideways.
Scene jerked_bed(std::uint64_t seed, bool whole);
/// Granules at rest on the floor under gravity.
Scene resting_bed(std::uint64_t seed, bool whole);
/// A cube filled to 62 %, shaken at 50 g.
Scene jammed_box(std::uint64_t seed, bool whole);
/// 30 granules in a box at resonance, cold: nothing moves at first.
Scene flung_gas(std::uint64_t seed, bool whole);
/// Sizes 1:10, masses 1:1000, shaken under gravity.
Scene size_contrast(std::uint64_t seed, bool whole);
/// A structure a thousand times lighter than its granules.
Scene light_structure(std::uint64_t seed, bool whole);
/// A structure without stiffness, struck.
Scene free_structure(std::uint64_t seed, bool whole);
/// A structure without damping at resonance.
Scene undamped_structure(std::uint64_t seed, bool whole);
/// A structure of 10 kHz, its period two contacts long.
Scene fast_structure(std::uint64_t seed, bool whole);
/// One granule as wide as the box less 1 %, shaken.
Scene tight_granule(std::uint64_t seed, bool whole);
/// One granule in a shaken cylinder, gravity across the axis.
Scene lone_granule(std::uint64_t seed, bool whole);
/// One granule 20 times as wide as thousands of others, under gravity.
Scene one_big(std::uint64_t seed, bool whole);

struct HardScene {
  const char* name;
  Scene (*make)(std::uint64_t seed, bool whole);
};

/// All of the above.
const std::vector<HardScene>& hard_scenes();

} // namespace grandamp::test
