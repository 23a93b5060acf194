#include "solver/step_review.hpp"

#include "solver/time_step.hpp"

#include <algorithm>

namespace grandamp {

namespace {
/// A contact may be followed by this share of the steps that the scene asks for. T_c goes with the fifth root of the
/// speed: that is at four times the speed that the step was made for.
constexpr double least_share = 0.75;
} // namespace

StepReview::StepReview(const Plan& plan)
    : on_(plan.scene.time.adaptive && plan.granules > 0), contact_duration_(plan.contact_duration),
      impact_speed_(plan.impact_speed), time_step_(plan.time_step) {}

std::int64_t StepReview::level_for(double speed) const {
  if (!(speed > impact_speed_)) return 0;
  const double wanted = least_share * contact_duration_ / time_step_;
  const double steps = contact_duration_at(contact_duration_, impact_speed_, speed) / time_step_;
  std::int64_t level = 0;
  const auto last = static_cast<std::int64_t>(parts.size()) - 1;
  while (level < last && steps * static_cast<double>(parts[static_cast<std::size_t>(level)]) < wanted) ++level;
  return level;
}

std::size_t StepReview::level_of(std::int64_t step_number) {
  if (!on_ || step_number == 0) return 0;
  const std::int64_t needed = level_for(state_.speed);
  if (step_number % interval == 0) {
    state_.level = needed;
    state_.speed = 0.0;
  } else
    state_.level = std::max(state_.level, needed);
  if (state_.level > 0) ++state_.refined;
  state_.finest = std::max(state_.finest, state_.level);
  return static_cast<std::size_t>(state_.level);
}

} // namespace grandamp
