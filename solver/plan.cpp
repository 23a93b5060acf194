#include "solver/plan.hpp"

#include "solver/cell_grid.hpp"
#include "solver/damper_numbers.hpp"
#include "solver/measures.hpp"
#include "solver/scene_check.hpp"
#include "solver/several_modes.hpp"
#include "solver/size_cut.hpp"
#include "solver/time_step.hpp"

#include <fmt/format.h>

namespace grandamp {

namespace {

bool several_sizes(const Scene& scene) {
  double radius = 0.0, mass = 0.0;
  for (const Population& population : scene.populations)
    for (std::size_t i = 0; i < population.count; ++i) {
      if (radius == 0.0) {
        radius = radius_of(population, i);
        mass = mass_of(population, i);
      }
      if (radius_of(population, i) != radius || mass_of(population, i) != mass) return true;
      if (population.radii.empty() && population.masses.empty()) break;
    }
  return false;
}

bool several_laws(const Scene& scene, const ContactTable& contacts) {
  const ContactLaw* granule = nullptr;
  const ContactLaw* wall = nullptr;
  for (std::size_t a = 0; a < contacts.populations; ++a) {
    if (scene.populations[a].count == 0) continue;
    if (!wall) wall = &contacts.wall[a];
    if (*wall != contacts.wall[a]) return true;
    for (std::size_t b = 0; b < contacts.populations; ++b) {
      if (scene.populations[b].count == 0) continue;
      if (!granule) granule = &contacts.between(a, b);
      if (*granule != contacts.between(a, b)) return true;
    }
  }
  return false;
}

void choose_effects(Plan& plan, const ContactTable& contacts) {
  const Scene& scene = plan.scene;
  const bool granules = plan.granules > 0;
  const bool friction = granules && scene.contact.friction != FrictionLaw::none;
  const bool spring = granules && scene.contact.friction == FrictionLaw::spring;
  const bool damped = granules && scene.contact.damping != NormalDamping::none;
  const bool box = scene.enclosure.shape == EnclosureShape::box;
  const auto effect = [&](const char* name, bool chosen) {
    (chosen ? plan.effects : plan.effects_left_out).emplace_back(name);
  };
  effect("hertz", granules);
  effect("tsuji", granules && scene.contact.damping == NormalDamping::tsuji);
  effect("linear", granules && scene.contact.damping == NormalDamping::linear);
  effect("only_pushes", damped && !scene.contact.tension);
  effect("coulomb", friction && !spring);
  effect("spring", spring);
  effect("rotation", friction && scene.contact.rotation);
  effect("polydisperse", several_sizes(scene));
  effect("materials", several_laws(scene, contacts));
  effect("gravity", granules && norm(scene.gravity) > 0.0);
  effect("box", granules && box);
  effect("cylinder", granules && !box);
  effect("structure", scene.structure.has_value());
  effect("modes", has_several_modes(scene));
  effect("harmonic", scene.excitation.kind == ExcitationKind::harmonic);
  effect("prescribed", scene.excitation.kind == ExcitationKind::prescribed);
  effect("base", scene.excitation.kind == ExcitationKind::base);
  effect("chirp", scene.excitation.kind == ExcitationKind::chirp);
  effect("random", scene.excitation.kind == ExcitationKind::random);
  effect("impulse", scene.excitation.kind == ExcitationKind::impulse);
  effect("table", scene.excitation.kind == ExcitationKind::table);
  effect("energy", scene.output.energy);
  effect("audit", granules && scene.verlet.audit > 0);
  effect("adaptive", granules && scene.time.adaptive);
  effect("verlet", granules && scene.time.integrator == Integrator::verlet);
  effect("mixed", granules && scene.time.precision == Precision::mixed);
}

void choose_list(Plan& plan, const std::vector<RadiusCount>& sizes) {
  const VerletControl& verlet = plan.scene.verlet;
  const double diameter = 2.0 * plan.largest_radius, mean_diameter = 2.0 * plan.mean_radius;
  const bool lists = verlet.policy != ListPolicy::none && verlet.policy != ListPolicy::all_pairs;
  plan.skin_tuned = lists && !verlet.skin && verlet.policy != ListPolicy::fixed;
  if (verlet.skin)
    plan.skin = *verlet.skin * diameter;
  else if (lists) {
    // Measured: 0.15 to 0.2 d is best for dense scenes, 0.3 to 0.4 d for dilute ones. Of unlike granules what counts is
    // how many candidates there are of each, and most of them are of the size of most.
    const double dense = std::clamp(plan.damper.fill_fraction / 0.3, 0.0, 1.0);
    // A fixed interval is for a skin that does not depend on what other sizes there are.
    plan.skin = (0.35 - 0.15 * dense) * (verlet.policy == ListPolicy::fixed ? diameter : mean_diameter);
    if (verlet.cell) plan.skin = std::min(plan.skin, (*verlet.cell - 1.0) * diameter);
  }
  if (!lists) plan.skin = 0.0; // looked for anew at every step
  const Vector3 box = bounding_box(plan.scene.enclosure);
  // Cells of a length that is asked for are for all granules.
  plan.small_radius = verlet.cell ? plan.largest_radius : largest_in_cells(sizes, plan.skin);
  plan.cell = verlet.cell ? *verlet.cell * diameter : 2.0 * plan.small_radius + plan.skin;
  if (plan.granules == 0) return;
  const GridShape shape = make_grid_shape(box, plan.cell, plan.granules);
  for (std::size_t k = 0; k < 3; ++k) plan.grid[static_cast<std::size_t>(shape.axis[k])] = shape.cells[k];
}

/// Granules listed in the scene: as they were read, and the plan's copy.
double listed_bytes(const Scene& scene) {
  std::size_t bytes = 0;
  for (const Population& population : scene.populations)
    bytes += sizeof(Vector3) * (population.positions.size() + population.velocities.size() + population.spins.size()) +
             sizeof(double) * (population.radii.size() + population.masses.size());
  return 2.0 * static_cast<double>(bytes);
}

/// Candidates of a list per granule: half of the neighbours whose centres are within a mean diameter and the skin.
/// Granules that fall, or are listed, may lie as a bed in whatever room.
double candidates_per_granule(const Plan& plan) {
  const std::vector<Population>& populations = plan.scene.populations;
  const bool lie =
      plan.scene.gravity != Vector3{0.0, 0.0, 0.0} ||
      std::any_of(populations.begin(), populations.end(), [](const Population& one) { return one.placed; });
  const double fill = lie ? std::max(bed_solid_fraction, plan.damper.fill_fraction) : plan.damper.fill_fraction;
  const double reach = 1.0 + 0.5 * plan.skin / plan.mean_radius;
  return std::min(0.5 * static_cast<double>(plan.granules), 4.0 * fill * reach * reach * reach);
}

/// Of the process, at its most, which is as a run begins or saves its state.
std::size_t estimate_memory(const Plan& plan) {
  if (plan.granules == 0) return 0;
  const bool ledger = plan.scene.output.energy, predicts = plan.scene.time.integrator == Integrator::verlet;
  const double springs = plan.scene.contact.friction == FrictionLaw::spring ? 1.0 : 0.0;
  const double candidates = candidates_per_granule(plan);
  constexpr double losses = 32.0, last_step = 64.0, losses_at_walls = 32.0 + 64.0 + 1.0, velocities = 64.0;

  // Bytes per granule: rows of position, motion and force, ids and scratch of the sort, and the list.
  double steps = 32.0 + 64.0 + 64.0 + 8.0 + 36.0 + 16.0 + (8.0 + 36.0 * springs) * candidates;
  // Where granules are put, and what the trial of the first step keeps for the step itself.
  double start = 92.0 + 32.0 + 64.0;
  // The fields of RunState, and one of them on its way to the file.
  double saved = 5.0 + 24.0 + 16.0 + 48.0 + 24.0 + 24.0 + (8.0 + 40.0 * springs) * candidates;
  if (ledger) {
    steps += losses + 2.0 * (last_step + losses_at_walls);
    start += losses_at_walls;
    saved += 24.0 + 8.0 + 8.0;
  }
  if (predicts) {
    steps += 2.0 * velocities;
    start += velocities;
    saved += 48.0;
  }
  // Where granules lie while they are poured is kept beside the state that is saved meanwhile.
  const bool poured = plan.scene.packing == PackingKind::settled && any_by_count(plan.scene);
  const double beside = poured ? start + saved : std::max(start, saved);

  // Some eight arrays, and seven of the ledger, are on whole large pages (solver/row_array.hpp) where they are large.
  constexpr double program = 20.0e6, allocator = 1.1, half_a_page = 1U << 20;
  const double large_pages = plan.granules >= (1U << 20) / sizeof(kernels::MotionRow) ? (ledger ? 15.0 : 8.0) : 0.0;
  const double cells = static_cast<double>(plan.grid[0]) * plan.grid[1] * plan.grid[2];
  return static_cast<std::size_t>(program + allocator * static_cast<double>(plan.granules) * (steps + beside) +
                                  listed_bytes(plan.scene) + 8.0 * cells + large_pages * half_a_page);
}

void note(Plan& plan, std::string key, std::string message) {
  Problem problem{std::move(key), "", std::move(message), ""};
  problem.note = true;
  plan.notes.push_back(std::move(problem));
}

void add_notes(Plan& plan) {
  const Scene& scene = plan.scene;
  if (plan.granules == 0) {
    note(plan, "granules", "no granules: the bare structure");
    return;
  }
  if (plan.step_choice) note(plan, "time.error", plan.step_choice->reason());
  if (plan.impact_speed_estimated)
    note(plan, "time.impact_speed",
         fmt::format(
             "the closing speed of {:.3g} m/s is estimated from the scene; the run watches the speeds that it meets",
             plan.impact_speed));
  if (scene.structure && !has_several_modes(scene) && scene.structure->stiffness > 0.0) {
    const Vector3& d = scene.structure->direction;
    const double along = scene.gravity[0] * d[0] + scene.gravity[1] * d[1] + scene.gravity[2] * d[2];
    const double deflection = plan.damper.granule_mass * along / scene.structure->stiffness;
    if (std::abs(deflection) > 0.0)
      note(plan, "structure.stiffness",
           fmt::format("the granules' weight moves the structure's rest to {:.4g} m", deflection));
  }
  if (scene.structure && plan.damper.mass_ratio > 1.0)
    note(plan, "structure.mass", fmt::format("the granules weigh {:.3g} times the structure", plan.damper.mass_ratio));
  if (scene.verlet.policy == ListPolicy::predicted || scene.verlet.policy == ListPolicy::fixed)
    note(plan, "verlet.policy", "this policy may miss contacts; set verlet.audit to count them");
  // The poured bed of bed_solid_fraction would not stay under the lid.
  if (plan.damper.fill_fraction > 0.55)
    note(plan, "granules", fmt::format("a solid fraction of {:.3g}: little room to move", plan.damper.fill_fraction));
}

} // namespace

Plan make_plan(const Scene& scene) {
  std::vector<Problem> faults = faults_of(scene);
  ContactTable contacts;
  try {
    contacts = make_contact_table(scene);
  } catch (const SceneError& error) {
    faults.insert(faults.end(), error.problems().begin(), error.problems().end());
  }
  if (!faults.empty()) throw SceneError(std::move(faults));

  Plan plan;
  plan.scene = scene;
  // A run that goes on beyond its end keeps the sweep that it began with.
  Excitation& excitation = plan.scene.excitation;
  if (excitation.kind == ExcitationKind::chirp && !excitation.sweep_duration)
    excitation.sweep_duration = excitation.period.value_or(scene.time.duration);
  plan.granules = granule_count(scene);
  const std::vector<RadiusCount> sizes = radius_counts(scene);
  if (!sizes.empty()) {
    plan.smallest_radius = sizes.front().radius;
    plan.largest_radius = sizes.back().radius;
    plan.mean_radius = mean_radius(sizes);
  }
  plan.damper = damper_numbers(scene);

  const TimeStep step = choose_time_step(scene, contacts);
  plan.impact_speed = step.impact_speed;
  plan.impact_speed_estimated = step.estimated;
  plan.contact_duration = step.contact_duration;
  plan.time_step_reason = step.reason;
  if (scene.time.adaptive && plan.granules > 0)
    plan.time_step_reason += "; in 3, 9 or 27 parts where granules come to be faster";
  plan.time_step = step.step;
  plan.steps = step.steps;
  plan.step_choice = step.choice;
  if (step.choice) plan.scene.time.integrator = step.choice->integrator;

  plan.window = scene.output.window.value_or(std::array<double, 2>{0.5 * scene.time.duration, scene.time.duration});
  choose_list(plan, sizes);
  choose_effects(plan, contacts);
  plan.memory = estimate_memory(plan);
  add_notes(plan);
  return plan;
}

} // namespace grandamp
