#include "solver/run_state.hpp"

#include "solver/measures.hpp"
#include "solver/step_review.hpp"

#include <cmath>
#include <type_traits>

#include <fmt/format.h>

namespace grandamp {

namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw StateError(what);
}

void demand_length(const char* name, std::size_t length, std::size_t wanted) {
  if (length != wanted) refuse(fmt::format("{} holds {} values, where {} belong", name, length, wanted));
}

void demand_range(const char* name, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value < least || value > most)
    refuse(fmt::format("{} is {}, where {} to {} are allowed", name, value, least, most));
}

constexpr std::int64_t most_counted = std::int64_t{1} << 60;

void check_numbers(const RunState& state) {
  visit_fields(state, [](const FieldInfo& info, const auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, double>) {
      if (!std::isfinite(value)) refuse(fmt::format("{} is not finite", info.name));
    } else if constexpr (std::is_same_v<Value, std::int64_t>) {
      demand_range(info.name, value, -1, most_counted);
    } else if constexpr (std::is_same_v<Value, std::vector<double>> || std::is_same_v<Value, std::vector<float>>) {
      for (const auto each : value)
        if (std::isnan(each)) refuse(fmt::format("{} holds what is no number", info.name));
    }
  });
}

void check_granules(const RunState& s, const Plan& plan) {
  const std::size_t count = plan.granules;
  demand_length("granules/id", s.id.size(), count);
  demand_length("granules/population", s.population.size(), count);
  demand_length("granules/position", s.position.size(), 3 * count);
  demand_length("granules/radius", s.radius.size(), count);
  demand_length("granules/inverse_mass", s.inverse_mass.size(), count);
  demand_length("granules/velocity", s.velocity.size(), 3 * count);
  demand_length("granules/surface_spin", s.surface_spin.size(), 3 * count);
  const std::size_t predicted = plan.scene.time.integrator == Integrator::verlet ? 3 * count : 0;
  demand_length("granules/predicted_velocity", s.predicted_velocity.size(), predicted);
  demand_length("granules/predicted_surface_spin", s.predicted_surface_spin.size(), predicted);
  const std::size_t ledger = plan.scene.output.energy ? 3 * count : 0;
  demand_length("granules/velocity_rate", s.velocity_rate.size(), ledger);
  demand_length("granules/surface_spin_rate", s.surface_spin_rate.size(), ledger);
  demand_length("granules/damping_granule", s.damping_granule.size(), ledger);
  demand_length("granules/friction_granule", s.friction_granule.size(), ledger);
  for (std::size_t k = 0; k < s.at_wall.size(); ++k)
    if (s.at_wall[k] >= (ledger > 0 ? count : 0) || (k > 0 && s.at_wall[k] <= s.at_wall[k - 1]))
      refuse(fmt::format("at_wall/row holds {} where rows of granules rise", s.at_wall[k]));
  demand_length("at_wall/damping", s.damping_wall.size(), 3 * s.at_wall.size());
  demand_length("at_wall/friction", s.friction_wall.size(), 3 * s.at_wall.size());
  demand_length("at_wall/friction_turn", s.friction_wall_turn.size(), 3 * s.at_wall.size());
  const bool coulomb = plan.scene.contact.friction == FrictionLaw::coulomb;
  demand_length("granules/friction_share", s.friction_share.size(), coulomb ? count : 0);
  for (const double share : s.friction_share)
    if (!(share > 0.0 && share <= 1.0)) refuse(fmt::format("granules/friction_share holds {}", share));

  std::vector<bool> seen(count, false);
  for (const std::uint32_t id : s.id) {
    if (id >= count || seen[id]) refuse(fmt::format("granules/id holds {} twice, or it is none of a granule", id));
    seen[id] = true;
  }
  const Vector3 size = bounding_box(plan.scene.enclosure);
  for (std::size_t i = 0; i < count; ++i) {
    if (s.population[i] >= plan.scene.populations.size())
      refuse(fmt::format("granules/population holds {}", s.population[i]));
    if (!(s.radius[i] >= plan.smallest_radius && s.radius[i] <= plan.largest_radius))
      refuse(fmt::format("granules/radius holds {} m", s.radius[i]));
    if (!(s.inverse_mass[i] > 0.0) || !std::isfinite(s.inverse_mass[i]))
      refuse(fmt::format("granules/inverse_mass holds {} 1/kg", s.inverse_mass[i]));
    for (std::size_t k = 0; k < 3; ++k) // a granule may be a little outside until a rebuild sees it
      if (!(std::abs(s.position[3 * i + k]) <= 1e3 * size[k]))
        refuse(fmt::format("granules/position holds {} m", s.position[3 * i + k]));
  }
}

} // namespace

void check_state(const RunState& s, const Plan& plan) {
  check_numbers(s);
  if (s.time_step != plan.time_step)
    refuse(fmt::format("the time step was {:.17g} s, and of the scene this program makes {:.17g} s", s.time_step,
                       plan.time_step));
  demand_range("steps", s.steps, 1, std::int64_t{1} << 52);
  demand_range("step_number", s.step_number, 0, s.steps);
  if (!(s.window[0] >= 0.0 && s.window[0] < s.window[1])) refuse("the window of the statistics is none");
  check_granules(s, plan);
  const std::int64_t levels = plan.scene.time.adaptive ? static_cast<std::int64_t>(StepReview::parts.size()) - 1 : 0;
  demand_range("review/level", s.review_level, 0, levels);
  demand_range("review/finest", s.review_finest, 0, levels);
  if (!(s.review_speed >= 0.0)) refuse("review/speed is negative");
  demand_length("enclosure/modes", s.enclosure_modes.size(),
                plan.scene.structure ? 2 * plan.scene.structure->modes.size : 0);
  for (const double coordinate : s.enclosure_modes)
    if (!std::isfinite(coordinate)) refuse("enclosure/modes is not finite");
  const bool displacement = plan.scene.verlet.policy == ListPolicy::displacement && s.list_built;
  demand_length("list/built_at", s.built_at.size(), displacement ? 3 * plan.granules : 0);
  if (!(s.skin >= 0.0 && s.skin <= 1e3 * (plan.largest_radius + 1.0))) refuse(fmt::format("list/skin is {} m", s.skin));
  if (!s.list_built) refuse("there is no list");
  if (s.unlisted.size() % 2 != 0) refuse("audit/unlisted holds half a contact");
}

} // namespace grandamp
