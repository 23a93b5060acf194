// Small scenes in code, for tests: two granules, a granule and a wall, a gas, a bed, the bare structure.
#pragma once

#include "solver/scene.hpp"

#include <cstdint>

namespace grandamp::test {

/// Granules of Table 1 and Fig. 6 of the paper: r = 1.5 mm, 1190 kg/m^3, k_n = 1e7 sqrt(r/3 mm), alpha = 0.077.
inline constexpr double acrylic_density = 1190.0;
double sphere_mass(double radius, double density = acrylic_density);

/// Acrylic: stiffness 1e7 (wall 1.3e7) at 3 mm, alpha = 0.077, friction 0.52; no gravity.
Contact acrylic_contact();

/// An empty box of `side` (m), no gravity, one population ready to take granules, acrylic contacts.
Scene box_scene(double side, double radius);

/// No damping and no friction.
void make_lossless(Scene& scene);

/// Adds a granule to the first population.
void add_granule(Scene& scene, const Vector3& position, const Vector3& velocity = {}, const Vector3& spin = {});

/// T_c = 3.2180 (m^2 / (k_n^2 v))^(1/5), s; `mass` the effective one.
double contact_duration(double mass, double stiffness, double closing_speed);
/// Of the first population's pairs, or of a granule at the wall.
double pair_contact_duration(const Scene& scene, double closing_speed);
double wall_contact_duration(const Scene& scene, double closing_speed);
/// The shorter of the two.
double shortest_contact_duration(const Scene& scene, double closing_speed);

/// Two granules on the line along `direction`, `gap` (m) apart, closing at 2 `speed`, in the middle of a wide box.
Scene two_granules(double radius, double speed, double gap, const Vector3& direction = {1.0, 0.0, 0.0});

/// One granule `gap` above the wall z = 0, with this velocity.
Scene granule_and_floor(double radius, double gap, const Vector3& velocity, const Vector3& spin = {});

/// `count` granules of 1.5 mm at random places without overlaps in a cube, each at `speed` in a random direction.
Scene gas(std::size_t count, double side, double speed, std::uint64_t seed);

/// A cluster of granules in the middle of a wide box, all heading for its centre, with spins: many collisions, no
/// walls.
Scene imploding_cluster(std::size_t count, std::uint64_t seed);

/// Table 5's box (25 x 25 x 35.9 mm) and structure, forced vertically; `count` granules of `radius` on a jittered
/// lattice just above the floor.
Scene vertical_damper(std::size_t count, double radius, double frequency, double duration);

/// Table 5: granules of 1.85 mm (317 of them in the paper), 15.91 Hz.
Scene table_5(std::size_t count, double duration);

/// The bare structure of Table 5: no granules.
Scene bare_structure();

} // namespace grandamp::test
