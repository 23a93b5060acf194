// What a time step does to one contact: single contacts, followed by the scalar oracle (kernels/reference.hpp) with the
// scene's own laws, at the step in question and at a far finer one, entered at all phases of a step. No clock takes
// part, so that the answer is the same on every machine.
#pragma once

#include "solver/material.hpp"

#include <array>
#include <string>
#include <vector>

namespace grandamp {

/// One kind of contact. What a pair does depends on its effective mass and Hertz's radius alone, for solid spheres: two
/// equal granules stand for every pair that has them.
struct ContactKind {
  ContactLaw law;
  bool wall = false;     ///< a granule against a wall; else two granules
  double mass = 0.0;     ///< effective, kg
  double radius = 0.0;   ///< R of Hertz, m
  double duration = 0.0; ///< T_c at 1 m/s, s
  std::string name;      ///< "acrylic against the wall"
};

/// How far a step is off, and where it is worst.
struct ContactError {
  double error = 0.0;
  std::string contact; ///< kind and impact: "acrylic against the wall, at 45 degrees"
};

/// Mean and standard deviation over phases of entry of the restitution of a head-on contact.
struct RestitutionMet {
  double mean = 0.0, deviation = 0.0;
  double exact = 0.0; ///< at a far finer step
};

/// The error of a contact: the root mean square over phases of entry of
///   sqrt(kinetic energy of what the final velocities and spins are off by / kinetic energy of the impact),
/// both of the relative motion. Head on it is the error of the restitution.
class ContactCalibration {
public:
  /// Follows every kind of contact at the closing speed `impact_speed` (m/s) with a fine step. Contacts that are not
  /// scale-free (linear damping, springs) are followed at an eighth of it, too.
  ContactCalibration(const Contact& contact, const std::vector<ContactKind>& kinds, double impact_speed);

  /// The largest error over kinds of contact and impacts: head on, and with friction also with 0.5, 0.71 and 0.87 of
  /// the speed along the surface (what offsets of 1/2, 1/sqrt 2 and sqrt(3)/2 give), and head on with spin.
  ContactError error_at(double step, Integrator integrator) const;
  /// Of the kind that lasts shortest.
  RestitutionMet restitution_at(double step, Integrator integrator) const;

private:
  using Vector = std::array<double, 3>;
  /// Of granule i; a partner's are the mirror image.
  struct Outcome {
    Vector velocity{}; ///< m/s
    Vector turn{};     ///< radius times spin, m/s
  };
  struct Impact {
    double along; ///< share of the speed along the surface
    double spin;  ///< slip by spin alone, over the speed
    const char* name;
  };
  struct Followed {
    ContactKind kind;
    double speed;                   ///< m/s
    std::vector<Outcome> converged; ///< one per impact
  };

  Outcome follow(const Followed& contact, const Impact& impact, double step, double phase, Integrator integrator) const;

  Contact laws_;
  std::vector<Impact> impacts_;
  std::vector<Followed> followed_;
};

} // namespace grandamp
