// The time step: a share of the shortest contact, T_c = 3.2180 (m^2 / (k_n^2 v))^(1/5), v being the closing speed that
// the scene is expected to bring about, and whatever else bounds an explicit step.
#pragma once

#include "solver/material.hpp"
#include "solver/step_choice.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

struct TimeStep {
  double impact_speed = 0.0;     ///< closing speed that T_c rests on, m/s
  bool estimated = true;         ///< from the scene; else as the scene gives it
  double contact_duration = 0.0; ///< T_c of the stiffest, lightest contact at impact_speed, s; 0 without granules
  double step = 0.0;             ///< s; steps * step = duration
  std::int64_t steps = 0;
  std::string reason;               ///< one sentence
  std::optional<StepChoice> choice; ///< with time.error
};

/// Undamped duration of a Hertz contact, s: 3.2180 (m^2 / (k^2 v))^(1/5).
double hertz_contact_duration(double effective_mass, double stiffness, double closing_speed);

/// T_c at another closing speed than the one at which it is known: as v^(-1/5).
double contact_duration_at(double contact_duration, double its_speed, double closing_speed);

/// Of every distinct law between granules and at walls, by the contact of it that lasts shortest.
ContactCalibration calibrate_contacts(const Scene& scene, const ContactTable& contacts, double impact_speed);

/// Throws SceneError if the scene's own `step` (or steps_per_contact) is above what is stable, or its `error` below
/// what can be reached.
TimeStep choose_time_step(const Scene& scene, const ContactTable& contacts);

} // namespace grandamp
