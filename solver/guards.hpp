// What stops a run, in words: what, where, when, and what to change.
#pragma once

#include "solver/errors.hpp"
#include "solver/granules.hpp"
#include "solver/plan.hpp"
#include "solver/verlet_list.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grandamp {

/// Hertz holds for small overlaps: beyond a tenth of a radius its force is a guess, beyond half nonsense.
inline constexpr double overlap_warning = 0.1;
inline constexpr double overlap_stop = 0.5;

/// Steps below which a contact is no longer followed; less where the scene itself starts from fewer.
inline constexpr double fewest_steps_per_contact = 3.5;

/// What a person may change so that contacts are followed by more steps.
inline constexpr const char* shorter_step = "raise time.steps_per_contact or time.impact_speed";
/// Policies that can miss a contact find it late, and deep: a half sentence that says so; empty for the others.
std::string list_advice(const Plan& plan);

struct GuardView {
  const Plan& plan;
  const Granules& granules;
  const VerletList& list;
  const std::vector<Wall>& walls;
  std::int64_t step_number;
  double time_step; ///< of the step numbers
  double part;      ///< in force: of an adaptive step's part
};

/// The closing speed at which a contact would be followed by too few steps, m/s.
double closing_speed_limit(const Plan& plan);

/// `max_overlap` over the smaller radius, met so far.
GuardError not_finite(const GuardView& view, double max_overlap);
GuardError too_deep(const GuardView& view, double overlap);
GuardError too_fast(const GuardView& view, double closing_speed);
GuardError escaped(const GuardView& view, std::int64_t count);
std::string deep_overlap_warning(const GuardView& view, double overlap);
std::string closing_speed_warning(const GuardView& view, double closing_speed);

} // namespace grandamp
