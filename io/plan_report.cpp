#include "io/plan_report.hpp"

#include "io/json.hpp"
#include "io/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp {
namespace {

// A bed that is shaken, one core of an EPYC of the Zen 4 kind (perf/results); a bed at rest takes up to three times as
// long.
constexpr double seconds_per_granule_step = 9.5e-9;
constexpr double seconds_per_step = 0.3e-6;
constexpr double price_of_the_ledger = 1.6; // 1.5 to 1.8 times as long
constexpr std::size_t granules_worth_a_thread = 20'000;

/// Time of a granule's step against that of a bed in the caches: two and a half times as much for a million granules.
double price_of_memory(std::size_t granules) {
  return std::clamp(1.0 + 0.62 * std::log10(static_cast<double>(granules + 1) / 3000.0), 1.0, 3.3);
}

/// Time of a granule's step against AVX-512.
double slowness(const std::string& isa) {
  return isa == "avx512" ? 1.0 : isa == "avx2" ? 1.1 : 11.0;
}

const char* name(ListPolicy policy) {
  switch (policy) {
  case ListPolicy::guarded:
    return "guarded";
  case ListPolicy::predicted:
    return "predicted";
  case ListPolicy::displacement:
    return "displacement";
  case ListPolicy::fixed:
    return "fixed";
  case ListPolicy::none:
    return "none";
  case ListPolicy::all_pairs:
    return "all-pairs";
  }
  return "";
}

std::string readable_bytes(std::size_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e6) return fmt::format("{:.0f} kB", value * 1e-3);
  if (value < 1e9) return fmt::format("{:.1f} MB", value * 1e-6);
  return fmt::format("{:.2f} GB", value * 1e-9);
}

class Sheet {
public:
  void line(std::string_view label, const std::string& text) { text_ += fmt::format("{:<18} {}\n", label, text); }
  /// Left out where the number has no meaning for the scene.
  void number(std::string_view label, double value, double factor, std::string_view unit) {
    if (std::isfinite(value)) line(label, fmt::format("{:.4g}{}{}", value * factor, unit.empty() ? "" : " ", unit));
  }
  const std::string& text() const { return text_; }

private:
  std::string text_;
};

std::string granules_line(const Plan& plan) {
  if (plan.granules == 0) return "none: the bare structure";
  std::string radii = fmt::format("radius {:.4g} mm", 1e3 * plan.smallest_radius);
  if (plan.largest_radius > plan.smallest_radius) radii += fmt::format(" to {:.4g} mm", 1e3 * plan.largest_radius);
  return fmt::format("{} in {} population{}, {}, {:.4g} kg in all", plan.granules, plan.scene.populations.size(),
                     plan.scene.populations.size() == 1 ? "" : "s", radii, plan.damper.granule_mass);
}

std::string search_line(const Plan& plan) {
  const ListPolicy policy = plan.scene.verlet.policy;
  std::string text = name(policy);
  if (policy == ListPolicy::all_pairs) return text;
  if (policy != ListPolicy::none) {
    text += fmt::format(", skin {:.4g} mm{}", 1e3 * plan.skin, plan.skin_tuned ? " (tuned as the run goes)" : "");
  }
  text +=
      fmt::format(", cells of {:.4g} mm, grid {} x {} x {}", 1e3 * plan.cell, plan.grid[0], plan.grid[1], plan.grid[2]);
  if (plan.small_radius < plan.largest_radius)
    text += fmt::format(", granules beyond {:.4g} mm looked for one by one", 1e3 * plan.small_radius);
  return text;
}

Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

} // namespace

WallTimeEstimate estimate_wall_time(const Plan& plan, const std::string& isa, int threads) {
  double per_granule = seconds_per_granule_step * slowness(isa);
  per_granule *= price_of_memory(plan.granules);
  if (plan.scene.output.energy) per_granule *= price_of_the_ledger;
  if (plan.scene.verlet.policy == ListPolicy::all_pairs) {
    per_granule += 0.5e-9 * slowness(isa) * static_cast<double>(plan.granules) / 2.0;
  }
  const int used = threads > 1 && plan.granules >= granules_worth_a_thread ? threads : 1;
  const double speed_up = 1.0 + 0.8 * (used - 1);
  const double per_step = seconds_per_step + per_granule * static_cast<double>(plan.granules) / speed_up;
  WallTimeEstimate estimate;
  estimate.seconds = per_step * static_cast<double>(plan.steps);
  estimate.basis = fmt::format(
      "{:.1f} ns per granule and step and {:.1f} us per step, from shaken beds on one core of an EPYC of the "
      "Zen 4 kind; {} on {} thread{}; pouring not counted; right within a factor of three, a bed at rest "
      "takes up to three times as long",
      per_granule * 1e9, seconds_per_step * 1e6, isa, used, used == 1 ? "" : "s");
  return estimate;
}

std::string plan_text(const Plan& plan, const std::string& isa, int threads) {
  Sheet sheet;
  if (!plan.scene.title.empty()) sheet.line("scene", plan.scene.title);
  sheet.line("granules", granules_line(plan));
  sheet.line("effects", fmt::format("{}", fmt::join(plan.effects, ", ")));
  sheet.line("left out", fmt::format("{}", fmt::join(plan.effects_left_out, ", ")));
  if (plan.granules > 0) {
    sheet.line("contact duration",
               fmt::format("T_c = {:.4g} s at a closing speed of {:.4g} m/s{}", plan.contact_duration,
                           plan.impact_speed, plan.impact_speed_estimated ? " (estimated from the scene)" : ""));
  }
  sheet.line("time step", fmt::format("{:.6g} s: {}", plan.time_step, plan.time_step_reason));
  if (plan.step_choice) {
    sheet.line("error",
               "of a contact: what its velocities and spins are off by, as the root of an energy over the impact's; "
               "the mean square over all phases of entry, of the worst contact and impact");
  }
  sheet.line("steps", fmt::format("{} for {:.6g} s", plan.steps, plan.time_step * static_cast<double>(plan.steps)));
  if (plan.scene.structure) {
    sheet.line("statistics", fmt::format("from {:.6g} s to {:.6g} s", plan.window[0], plan.window[1]));
  }
  if (plan.granules > 0) sheet.line("search", search_line(plan));
  sheet.number("mass ratio", plan.damper.mass_ratio, 1.0, "granules / structure");
  sheet.number("fill fraction", plan.damper.fill_fraction, 100.0, "% of the enclosure is solid");
  sheet.number("clearance", plan.damper.clearance, 1e3, "mm above the bed at 60 % solid");
  sheet.number("acceleration", plan.damper.acceleration, 1.0, "g at most, the bare enclosure");
  sheet.number("natural frequency", plan.damper.natural_frequency, 1.0, "Hz without granules");
  sheet.number("", plan.damper.loaded_frequency, 1.0, "Hz with the granules as added mass");
  sheet.line("memory", "about " + readable_bytes(plan.memory));
  const WallTimeEstimate estimate = estimate_wall_time(plan, isa, threads);
  sheet.line("wall time", fmt::format("about {} ({})", readable_seconds(estimate.seconds), estimate.basis));
  return sheet.text();
}

std::string plan_json(const Plan& plan, const std::string& isa, int threads) {
  const WallTimeEstimate estimate = estimate_wall_time(plan, isa, threads);
  const DamperNumbers& damper = plan.damper;
  Json json;
  json["title"] = plan.scene.title;
  json["granules"] = plan.granules;
  json["duration"] = plan.scene.time.duration;
  json["time_step"] = plan.time_step;
  json["time_step_reason"] = plan.time_step_reason;
  json["steps"] = plan.steps;
  if (const auto& choice = plan.step_choice) {
    json["step_choice"] = {{"asked", choice->asked},
                           {"error", choice->error},
                           {"contact", choice->contact},
                           {"steps_per_contact", choice->steps_per_contact},
                           {"integrator", choice->integrator == Integrator::verlet ? "verlet" : "leapfrog"}};
  }
  json["contact_duration"] = plan.contact_duration;
  json["impact_speed"] = plan.impact_speed;
  json["impact_speed_estimated"] = plan.impact_speed_estimated;
  json["effects"] = plan.effects;
  json["effects_left_out"] = plan.effects_left_out;
  json["window"] = plan.window;
  json["verlet"] = {{"policy", name(plan.scene.verlet.policy)},
                    {"skin", plan.skin},
                    {"skin_tuned", plan.skin_tuned},
                    {"cell", plan.cell},
                    {"small_radius", plan.small_radius},
                    {"grid", plan.grid}};
  json["damper"] = {{"granule_mass", finite_or_null(damper.granule_mass)},
                    {"mass_ratio", finite_or_null(damper.mass_ratio)},
                    {"fill_fraction", finite_or_null(damper.fill_fraction)},
                    {"clearance", finite_or_null(damper.clearance)},
                    {"acceleration", finite_or_null(damper.acceleration)},
                    {"natural_frequency", finite_or_null(damper.natural_frequency)},
                    {"loaded_frequency", finite_or_null(damper.loaded_frequency)}};
  json["isa"] = isa;
  json["memory"] = plan.memory;
  json["wall_time"] = {{"estimate", estimate.seconds}, {"basis", estimate.basis}};
  json["notes"] = Json::array();
  for (const Problem& note : plan.notes) json["notes"].push_back({{"key", note.key}, {"message", note.message}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace grandamp
