// The constants of every contact of a scene: granule against granule and granule against wall, by population.
#pragma once

#include "solver/scene.hpp"

#include <vector>

namespace grandamp {

/// Of one kind of contact. Hertz: F = k_n d^1.5 with k_n = stiffness_coefficient * sqrt(R), R = r_i r_j / (r_i + r_j)
/// between granules and r_i at a wall (Fang et al. 2007, Eqs. 4 and 5 as corrected).
struct ContactLaw {
  double stiffness_coefficient = 0.0;            ///< N/m^2
  double alpha = 0.0;                            ///< Tsuji: D_n = alpha sqrt(m k_n) d^(1/4) d'
  double normal_damping = 0.0;                   ///< linear: D_n = normal_damping d', N s/m
  double friction = 0.0;                         ///< mu
  double tangential_stiffness_coefficient = 0.0; ///< spring: C_t, the force grows by C_t sqrt(R d) ds, N/m^2
  double tangential_damping = 0.0;               ///< spring: c_t, N s/m

  bool operator==(const ContactLaw&) const = default;
};

/// All kinds of contact. `granule` is populations x populations, row-major and symmetric; `wall` one per population.
struct ContactTable {
  std::size_t populations = 0;
  std::vector<ContactLaw> granule;
  std::vector<ContactLaw> wall;

  const ContactLaw& between(std::size_t a, std::size_t b) const { return granule[a * populations + b]; }
};

/// Tsuji's constant for a restitution in (0, 1]: alpha = -sqrt(5) ln e / sqrt(ln^2 e + pi^2), exact for any speed.
double tsuji_alpha(double restitution);
/// The same for a contact that only pushes, F_n >= 0.
double tsuji_alpha_without_tension(double restitution);

/// Throws SceneError where a stiffness or a constant is missing.
ContactTable make_contact_table(const Scene& scene);

} // namespace grandamp
