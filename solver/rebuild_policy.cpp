#include "solver/rebuild_policy.hpp"

#include <algorithm>

namespace grandamp {

namespace {
// Relative cost of one candidate test and of listing one granule, from the benches of the kernels. Only their ratio
// matters, and the least cost is flat about the best skin.
constexpr double cost_of_candidate = 1.0;
constexpr double cost_of_rebuild = 45.0;
constexpr std::int64_t rebuilds_per_trial = 12;
constexpr std::int64_t steps_per_trial = 400;
} // namespace

void SkinTuner::note(double candidates_per_granule, std::int64_t interval) {
  if (!active) return;
  ++rebuilds;
  steps += interval;
  candidates += candidates_per_granule * static_cast<double>(interval);
  if (rebuilds < rebuilds_per_trial || steps < steps_per_trial) return;
  const double cost =
      (cost_of_candidate * candidates + cost_of_rebuild * static_cast<double>(rebuilds)) / static_cast<double>(steps);
  if (last_cost > 0.0 && cost > last_cost) factor = 1.0 / factor;
  last_cost = cost;
  skin = std::clamp(skin * factor, least, largest);
  rebuilds = steps = 0;
  candidates = 0.0;
}

bool rebuild_due(const VerletControl& control, const ListAge& age, double skin) {
  if (!age.built) return true;
  switch (control.policy) {
  case ListPolicy::guarded:
    return 2.0 * age.travelled > skin;
  case ListPolicy::displacement:
    return 2.0 * age.farthest > skin;
  case ListPolicy::predicted:
    return age.steps >= age.allowed;
  case ListPolicy::fixed:
    return age.steps >= control.interval;
  case ListPolicy::none:
  case ListPolicy::all_pairs:
    return age.steps >= 1;
  }
  return true;
}

std::int64_t predicted_interval(const VerletControl& control, double skin, double max_speed, double time_step) {
  const double steps = skin / (2.0 * control.safety * max_speed * time_step); // infinite at rest: the cap holds
  if (!(steps < static_cast<double>(control.max_interval))) return control.max_interval;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
}

} // namespace grandamp
