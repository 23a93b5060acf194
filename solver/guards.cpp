#include "solver/guards.hpp"

#include "solver/step_review.hpp"
#include "solver/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace grandamp {

namespace {

std::string when(const GuardView& view) {
  return fmt::format("at t = {:.9g} s (step {})", static_cast<double>(view.step_number) * view.time_step,
                     view.step_number);
}

std::string granule_text(const GuardView& view, std::uint32_t row) {
  const kernels::PositionRow& p = view.granules.position[row];
  const kernels::MotionRow& m = view.granules.motion[row];
  const std::uint8_t population = view.granules.population[row];
  return fmt::format("granule {} ({}) at ({:.6g}, {:.6g}, {:.6g}) m, velocity ({:.4g}, {:.4g}, {:.4g}) m/s relative to "
                     "the enclosure",
                     view.granules.id[row], view.plan.scene.populations[population].name, p.x, p.y, p.z, m.velocity[0],
                     m.velocity[1], m.velocity[2]);
}

double contact_steps(const GuardView& view, double closing_speed) {
  return contact_duration_at(view.plan.contact_duration, view.plan.impact_speed, closing_speed) / view.part;
}

/// The listed contact with the deepest overlap, in words; empty if none is listed.
std::string deepest_contact(const GuardView& view) {
  double deepest = 0.0;
  std::string text;
  for (const Segment& segment : view.list.segments()) {
    for (const PairList* pairs : {&segment.inner, &segment.boundary})
      for (std::size_t k = 0; k < pairs->count(); ++k) {
        const std::uint32_t i = pairs->data()[k].first(), j = pairs->data()[k].second();
        const kernels::PositionRow &a = view.granules.position[i], &b = view.granules.position[j];
        const double overlap = a.radius + b.radius - std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
        const double ratio = overlap / std::min(a.radius, b.radius);
        if (!(ratio > deepest)) continue;
        deepest = ratio;
        text = granule_text(view, i) + " against " + granule_text(view, j);
      }
    for (std::size_t w = 0; w < view.walls.size(); ++w)
      for (std::size_t k = 0; k < segment.walls[w].count; ++k) {
        const std::uint32_t i = segment.walls[w].granules[k];
        const kernels::PositionRow& a = view.granules.position[i];
        const double ratio = (a.radius - distance_inside(view.walls[w], a)) / a.radius;
        if (!(ratio > deepest)) continue;
        deepest = ratio;
        text = granule_text(view, i) + " against the wall " + view.walls[w].name;
      }
  }
  return text;
}

/// Velocity, position and spin are numbers whose squares are, too.
bool sound(const GuardView& view, std::uint32_t row) {
  const kernels::MotionRow& m = view.granules.motion[row];
  const kernels::PositionRow& p = view.granules.position[row];
  double square = 0.0;
  for (const double v : {m.velocity[0], m.velocity[1], m.velocity[2], m.surface_spin[0], m.surface_spin[1],
                         m.surface_spin[2], p.x, p.y, p.z})
    square += v * v;
  return std::isfinite(square);
}

/// The granules and walls that a granule touches by the list, or whose state does not tell, in words.
std::string neighbours_of(const GuardView& view, std::uint32_t row) {
  constexpr std::size_t most_told = 6;
  std::vector<std::string> told;
  const auto tell = [&](const std::string& who, double overlap, double radius) {
    if (overlap <= 0.0) return; // not a number: it is told
    told.push_back(std::isfinite(overlap) ? fmt::format("{}, {:.3g} % of a radius deep", who, 100.0 * overlap / radius)
                                          : who + ", no longer measurable");
  };
  const kernels::PositionRow& a = view.granules.position[row];
  for (const Segment& segment : view.list.segments()) {
    for (const PairList* pairs : {&segment.inner, &segment.boundary})
      for (std::size_t k = 0; k < pairs->count(); ++k) {
        const std::uint32_t i = pairs->data()[k].first(), j = pairs->data()[k].second();
        if ((i != row && j != row) || i >= view.granules.count()) continue;
        const std::uint32_t other = i == row ? j : i;
        const kernels::PositionRow& b = view.granules.position[other];
        tell(fmt::format("granule {}{}", view.granules.id[other], sound(view, other) ? "" : " (not finite either)"),
             a.radius + b.radius - std::hypot(b.x - a.x, b.y - a.y, b.z - a.z), std::min(a.radius, b.radius));
      }
    for (std::size_t w = 0; w < view.walls.size(); ++w)
      for (std::size_t k = 0; k < segment.walls[w].count; ++k)
        if (segment.walls[w].granules[k] == row)
          tell("the wall " + view.walls[w].name, a.radius - distance_inside(view.walls[w], a), a.radius);
  }
  if (told.empty()) return "touching nothing that is listed";
  std::string text = "touching " + told.front();
  for (std::size_t k = 1; k < std::min(told.size(), most_told); ++k) text += "; " + told[k];
  if (told.size() > most_told) text += fmt::format("; and {} more", told.size() - most_told);
  return text;
}

} // namespace

std::string list_advice(const Plan& plan) {
  const ListPolicy policy = plan.scene.verlet.policy;
  if (policy != ListPolicy::predicted && policy != ListPolicy::fixed) return "";
  return "; or the list was too old when they met: verlet.policy = \"guarded\" misses no contact";
}

double closing_speed_limit(const Plan& plan) {
  if (plan.granules == 0) return std::numeric_limits<double>::infinity();
  double steps = plan.contact_duration / plan.time_step;
  if (plan.scene.time.adaptive) steps *= static_cast<double>(StepReview::parts.back());
  return plan.impact_speed * std::pow(steps / std::min(fewest_steps_per_contact, 0.95 * steps), 5.0);
}

GuardError not_finite(const GuardView& view, double max_overlap) {
  std::uint32_t first = 0; // by id: rows are in no order that a person knows
  bool found = false;
  for (std::uint32_t i = 0; i < view.granules.count(); ++i) {
    if (sound(view, i) || (found && view.granules.id[i] > view.granules.id[first])) continue;
    first = i;
    found = true;
  }
  const std::string who = found ? granule_text(view, first) + ", " + neighbours_of(view, first) : "no granule's own";
  return GuardError(
      fmt::format("a velocity is not finite {}: {}; the deepest overlap met so far is {:.3g} % of a radius; "
                  "the step is too long for the forces met: {}{}",
                  when(view), who, 100.0 * max_overlap, shorter_step, list_advice(view.plan)));
}

GuardError too_deep(const GuardView& view, double overlap) {
  return GuardError(fmt::format(
      "an overlap of {:.0f} % of a radius {} (Hertz allows none beyond {:.0f} %): {}; make the contact stiffer "
      "(contact.granule.stiffness, contact.wall.stiffness), or {}{}",
      100.0 * overlap, when(view), 100.0 * overlap_stop, deepest_contact(view), shorter_step, list_advice(view.plan)));
}

GuardError too_fast(const GuardView& view, double closing_speed) {
  return GuardError(fmt::format(
      "granules closed at {:.4g} m/s {}; the time step of {:.4g} s rests on {:.4g} m/s, and such a contact lasts only "
      "{:.2g} steps; set time.impact_speed = {:.3g} (or raise time.steps_per_contact)",
      closing_speed, when(view), view.part, view.plan.impact_speed, contact_steps(view, closing_speed),
      1.5 * closing_speed));
}

GuardError escaped(const GuardView& view, std::int64_t count) {
  std::string who;
  for (const Segment& segment : view.list.segments())
    if (who.empty() && !segment.outside.empty())
      who = granule_text(view, segment.outside.front()) + ", " + neighbours_of(view, segment.outside.front());
  return GuardError(
      fmt::format("{} granule{} left the enclosure {}: {}; the walls are too soft or the step is too long: "
                  "raise contact.wall.stiffness, or {}{}",
                  count, count == 1 ? "" : "s", when(view), who, shorter_step, list_advice(view.plan)));
}

std::string deep_overlap_warning(const GuardView& view, double overlap) {
  return fmt::format("an overlap of {:.0f} % of a radius {}: deep for Hertz (the run stops at {:.0f} %); {}",
                     100.0 * overlap, when(view), 100.0 * overlap_stop, deepest_contact(view));
}

std::string closing_speed_warning(const GuardView& view, double closing_speed) {
  return fmt::format("granules closed at {:.4g} m/s {}, faster than the {:.4g} m/s that the time step rests on: such a "
                     "contact lasts {:.2g} steps (the run stops at {:.4g} m/s)",
                     closing_speed, when(view), view.plan.impact_speed, contact_steps(view, closing_speed),
                     closing_speed_limit(view.plan));
}

} // namespace grandamp
