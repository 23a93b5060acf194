// The impacts of Chung & Ooi, Granular Matter 13 (2011) 643, tests 1 to 4: what hits what, what should come of it, and
// what came of it last.
#pragma once

#include <string_view>

namespace grandamp::test::chung_ooi {

struct Material {
  double young; ///< Pa
  double poisson;
  double density; ///< kg/m^3
};

inline constexpr Material glass{4.8e10, 0.20, 2800.0}, limestone{2.0e10, 0.25, 2500.0};
inline constexpr Material aluminium_alloy{7.0e10, 0.30, 2699.0}, magnesium_alloy{4.0e10, 0.35, 1800.0};
inline constexpr Material aluminium_oxide{3.8e11, 0.23, 4000.0}, cast_iron{1.0e11, 0.25, 7000.0};

enum class Partner { twin, rigid_wall, wall_a_thousand_times_stiffer };

/// Largest overlap (m) and force (N), and how long the contact lasts (s).
struct Peak {
  double overlap, force, duration;
};

/// A head-on hit without losses, by the closed form of Hertz.
struct ElasticImpact {
  std::string_view name;
  Material material;
  double radius;        ///< m
  double closing_speed; ///< m/s
  Partner partner;
  Peak closed_form;
  Peak last; ///< of this program, at 400 steps a contact
};

/// Test 4: aluminium oxide, 2.5 mm, 3.9 m/s against a wall a thousand times stiffer; restitution 0.98, friction 0.092.
struct ObliqueImpact {
  double degrees;                ///< of the incident velocity, from the wall's normal
  double tangential_restitution; ///< of the centre's velocity
  double spin;                   ///< after the hit, rad/s
  double rebound_degrees;        ///< of the contact point's velocity, from the normal
  bool slides_throughout;        ///< then the figures are closed forms; else they are read off the published curves
};

} // namespace grandamp::test::chung_ooi
