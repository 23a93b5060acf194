#include "solver/energy_watch.hpp"

#include "solver/guards.hpp"
#include "solver/time_step.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace grandamp {

namespace {
constexpr std::int64_t samples_in_a_row = 10;
} // namespace

double EnergyWatch::explained(double steps_per_contact) {
  return 4.8 / (steps_per_contact * steps_per_contact);
}

std::optional<std::string> EnergyWatch::note(const Sample& sample, const Plan& plan, const GuardStatistics& guards) {
  if (!plan.scene.output.energy || plan.granules == 0) return std::nullopt;
  const StoredEnergy& e = sample.stored;
  const Ledger& l = sample.ledger;
  const double losses = l.structural_damping + l.normal_granule + l.normal_wall + l.friction_granule + l.friction_wall;
  const double balance = e.kinetic + e.gravitational + e.elastic + e.structure + losses - l.work_in;
  if (state_.samples++ == 0) {
    state_.first = balance;
    state_.gravitational = e.gravitational;
  }
  for (const double term : {e.kinetic, e.elastic, e.structure, e.gravitational - state_.gravitational, l.work_in,
                            l.structural_damping, l.normal_granule, l.normal_wall, l.friction_granule, l.friction_wall})
    state_.largest = std::max(state_.largest, std::abs(term));

  const double speed = std::max(guards.max_closing, plan.impact_speed);
  const double steps = contact_duration_at(plan.contact_duration, plan.impact_speed, speed) / plan.time_step;
  const double off = balance - state_.first, allowed = explained(steps);
  state_.beyond = std::abs(off) > allowed * state_.largest ? state_.beyond + 1 : 0;
  if (state_.warned || state_.beyond < samples_in_a_row) return std::nullopt;
  state_.warned = true;
  return fmt::format(
      "the energy balance is off by {:+.3g} J at t = {:.9g} s, {:.3g} % of its largest term, where {:.2g} "
      "steps to the fastest contact explain {:.2g} %; {}{}",
      off, sample.time, 100.0 * std::abs(off) / state_.largest, steps, 100.0 * allowed, shorter_step,
      list_advice(plan));
}

} // namespace grandamp
