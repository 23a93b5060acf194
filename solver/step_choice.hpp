// [time] error: the fewest steps in a contact whose error is below the one asked for.
#pragma once

#include "solver/contact_error.hpp"

#include <functional>
#include <string>
#include <vector>

namespace grandamp {

/// What `time.error` led to.
struct StepChoice {
  double asked = 0.0;             ///< error asked for
  double error = 0.0;             ///< of a contact at the step chosen (solver/contact_error.hpp)
  double steps_per_contact = 0.0; ///< k of T_c / k
  Integrator integrator = Integrator::leapfrog;
  std::string contact;        ///< the one that is worst
  double coarser_steps = 0.0; ///< k of the next coarser step, which will not do; 0: there is none
  double coarser_error = 0.0; ///< largest error at it or at what stands for its slower contacts
  std::string coarser_contact;

  std::string reason() const; ///< in words
};

/// Of a ladder of steps in a contact from 4 to 256, each at most a quarter above the one before, the fewest at which
/// the error is at most `scene.time.error`; and also at every finer step up to four times as many, as which slower
/// contacts see the same step. The ladder is coarse so that the last bits of a machine's mathematical functions cannot
/// turn the choice. If the scene leaves the integrator free, velocity Verlet is taken where it gets by with fewer
/// steps. `step_at(k)`: the step, s, that k steps in a contact lead to. Throws SceneError if no step will do.
StepChoice choose_steps(const Scene& scene, const std::vector<ContactKind>& kinds, double impact_speed,
                        const std::function<double(double)>& step_at);

} // namespace grandamp
