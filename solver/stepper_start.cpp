// How a Stepper comes to its first step.
#include "solver/guards.hpp"
#include "solver/measures.hpp"
#include "solver/several_modes.hpp"
#include "solver/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace grandamp {

static_assert(most_granules + 2 <= kernels::most_rows); // and the two ghosts

using kernels::MotionRow;
using kernels::Observation;
using kernels::PositionRow;
using kernels::Variety;

namespace {

kernels::Damping damping_of(const Contact& contact) {
  switch (contact.damping) {
  case NormalDamping::tsuji:
    return contact.tension ? kernels::Damping::tsuji : kernels::Damping::tsuji_without_tension;
  case NormalDamping::linear:
    return contact.tension ? kernels::Damping::linear : kernels::Damping::linear_without_tension;
  case NormalDamping::none:
    break;
  }
  return kernels::Damping::none;
}

kernels::Friction friction_of(const Contact& contact) {
  if (contact.friction == FrictionLaw::none) return kernels::Friction::none;
  if (contact.friction == FrictionLaw::spring)
    return contact.rotation ? kernels::Friction::spring : kernels::Friction::spring_without_rotation;
  return contact.rotation ? kernels::Friction::coulomb : kernels::Friction::coulomb_without_rotation;
}

bool all_equal(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
}

bool all_equal(const std::vector<ContactLaw>& laws) {
  return std::adjacent_find(laws.begin(), laws.end(), [](const auto& a, const auto& b) { return !(a == b); }) ==
         laws.end();
}

std::vector<kernels::LawRow> law_rows(const std::vector<ContactLaw>& laws, NormalDamping damping) {
  std::vector<kernels::LawRow> rows;
  rows.reserve(laws.size());
  for (const ContactLaw& law : laws)
    rows.push_back({law.stiffness_coefficient, damping == NormalDamping::linear ? law.normal_damping : law.alpha,
                    law.friction, 0.0});
  if (rows.empty()) rows.push_back({});
  return rows;
}

std::vector<kernels::SpringLawRow> spring_law_rows(const std::vector<ContactLaw>& laws) {
  std::vector<kernels::SpringLawRow> rows;
  rows.reserve(laws.size());
  for (const ContactLaw& law : laws)
    rows.push_back({law.tangential_stiffness_coefficient, law.tangential_damping, {0.0, 0.0}});
  if (rows.empty()) rows.push_back({});
  return rows;
}

/// Verlet's forces see the velocity half a step ahead: a slip s that loses the share a of itself in a step follows
/// s'' = (1 - 3a/2) s' + (a/2) s, which grows beyond a = 1 where leapfrog's s' = (1 - a) s bears 2.
constexpr double verlet_share = 0.5;
/// What the slip of a solid sphere feels of its mass, when it can spin.
constexpr double rolling_mass_share = 2.0 / 7.0;

/// Granules that can lean on the enclosure's walls at once: what fits side by side, hexagons of 2 sqrt(3) r^2 each.
double most_wall_contacts(const Plan& plan) {
  const Enclosure& enclosure = plan.scene.enclosure;
  const Vector3 l = bounding_box(enclosure);
  const double area = 2.0 * (l[0] * l[1] + l[1] * l[2] + l[2] * l[0]);
  const double fit = area / (2.0 * std::numbers::sqrt3 * plan.smallest_radius * plan.smallest_radius);
  return std::max(1.0, std::min(fit, static_cast<double>(plan.granules)));
}

} // namespace

Stepper::Stepper(const Plan& plan, const Placement& start, kernels::InstructionSet isa, int threads)
    : Stepper(plan, all_equal(start.radius) && all_equal(start.mass), isa, threads) {
  place(start);
  take_half_step_back();
}

Stepper::Stepper(const Plan& plan, bool same_sizes, kernels::InstructionSet isa, int threads)
    : plan_(plan), time_step_(plan.time_step), part_(plan.time_step), isa_(isa), team_(threads),
      walls_(make_walls(plan.scene.enclosure)), size_(bounding_box(plan.scene.enclosure)),
      contacts_(make_contact_table(plan.scene)), closing_limit_(closing_speed_limit(plan)), review_(plan),
      motion_(plan.scene, plan.time_step) {
  const Contact& contact = plan_.scene.contact;
  contact_effects_.damping = damping_of(contact);
  contact_effects_.friction = friction_of(contact);
  contact_effects_.variety = !all_equal(contacts_.granule) || !all_equal(contacts_.wall) ? Variety::materials
                             : !same_sizes                                               ? Variety::sizes
                                                                                         : Variety::alike;
  contact_effects_.precision =
      plan_.scene.time.precision == Precision::mixed ? kernels::Precision::mixed : kernels::Precision::full;
  same_sizes_ = same_sizes;
  pair_laws_ = law_rows(contacts_.granule, contact.damping);
  wall_laws_ = law_rows(contacts_.wall, contact.damping);
  pair_spring_laws_ = spring_law_rows(contacts_.granule);
  wall_spring_laws_ = spring_law_rows(contacts_.wall);
  const bool verlet = plan_.scene.time.integrator == Integrator::verlet;
  friction_cap_ = (verlet ? verlet_share : 1.0) * (contact_effects_.rotates() ? rolling_mass_share : 1.0) / time_step_;
  if (plan_.scene.structure && plan_.granules > 0) {
    enclosure_inverse_mass_ = 1.0 / fastest_oscillator(*plan_.scene.structure).mass;
    // Many walls' contacts brake the same structure at once: each is allowed its share of that mass.
    friction_inverse_mass_ = enclosure_inverse_mass_ * most_wall_contacts(plan_);
  }
  if (review_.on())
    for (std::size_t level = 1; level < StepReview::parts.size(); ++level)
      motion_in_parts_.emplace_back(plan_.scene, time_step_ / static_cast<double>(StepReview::parts[level]));
  choose_mobility();
  motion_effects_.integration = verlet ? kernels::Integration::verlet : kernels::Integration::leapfrog;
  motion_effects_.rubbing = contact_effects_.rotates()  ? kernels::Rubbing::with_rotation
                            : contact_effects_.counts() ? kernels::Rubbing::without_rotation
                                                        : kernels::Rubbing::none;
  motion_effects_.accelerated = motion_.moves() || plan_.scene.gravity != Vector3{0.0, 0.0, 0.0};
  choose_kernels();

  const ListPolicy policy = plan_.scene.verlet.policy;
  skin_ = policy == ListPolicy::none || policy == ListPolicy::all_pairs ? 0.0 : plan_.skin;
  tuner_.active = plan_.skin_tuned && skin_ > 0.0 && policy != ListPolicy::fixed;
  tuner_.skin = skin_;
  tuner_.least = 0.04 * 2.0 * plan_.mean_radius;
  tuner_.largest = 0.8 * 2.0 * plan_.mean_radius;
  if (plan_.scene.verlet.cell) tuner_.largest = std::min(tuner_.largest, plan_.cell - 2.0 * plan_.largest_radius);
  tuner_.least = std::min(tuner_.least, tuner_.largest);
  search_ = VerletList::Search::with(isa_, contact_effects_.variety == Variety::alike, plan_.largest_radius);
  search_.small_radius = plan_.small_radius;

  touch_ahead_ = plan_.granules * (sizeof(PositionRow) + sizeof(MotionRow) + sizeof(kernels::ForceRow)) > 1U << 20;
}

/// One degree of freedom yields along its direction. Several yield otherwise in each direction: n . B n along the
/// normal n of a plane, B being the mobility of the enclosure; on a cylinder's side, where n turns, along the line that
/// yields most.
void Stepper::choose_mobility() {
  wall_mobility_.assign(walls_.size(), {motion_.direction(), enclosure_inverse_mass_});
  if (enclosure_inverse_mass_ == 0.0 || !has_several_modes(plan_.scene)) return;
  const std::array<double, 9> b = modal_numbers(plan_.scene.structure->modes).mobility;
  const auto yields = [&b](const Vector3& n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) sum += n[i] * b[3 * i + k] * n[k];
    return sum;
  };
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const kernels::WallSurface& surface = walls_[w].surface;
    if (!walls_[w].side) {
      const Vector3 normal{surface.normal[0], surface.normal[1], surface.normal[2]};
      wall_mobility_[w] = {normal, std::max(0.0, yields(normal))};
      continue;
    }
    wall_mobility_[w].inverse_mass = 0.0;
    const std::size_t u = surface.across[0] != 0.0 ? 0 : 1, v = surface.across[2] != 0.0 ? 2 : 1;
    const double angle = 0.5 * std::atan2(2.0 * b[3 * u + v], b[4 * u] - b[4 * v]);
    Vector3 line{};
    line[u] = std::cos(angle);
    line[v] = std::sin(angle);
    wall_mobility_[w] = {line, std::max(0.0, yields(line))};
  }
}

void Stepper::choose_kernels() {
  const bool ledger = plan_.scene.output.energy;
  const auto chosen = [&](Observation observation) {
    kernels::ContactEffects contact = contact_effects_;
    kernels::MotionEffects motion = motion_effects_;
    contact.observation = motion.observation = observation;
    return Kernels{kernels::pair_kernel_for(isa_, contact), kernels::plane_kernel_for(isa_, contact),
                   kernels::side_kernel_for(isa_, contact), kernels::motion_kernel_for(isa_, motion)};
  };
  plain_ = chosen(ledger ? Observation::ledger : Observation::none);
  with_energies_ = chosen(ledger ? Observation::ledger_and_energies : Observation::energies);
}

void Stepper::place(const Placement& start) {
  const std::size_t count = start.position.size();
  granules_ = Granules(count, {.predicted = motion_effects_.integration == kernels::Integration::verlet,
                               .ledger = plan_.scene.output.energy,
                               .shares = contact_effects_.counts()});
  const Vector3 frame = motion_.velocity_of(motion_.initial_state());
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 &p = start.position[i], &v = start.velocity[i], &w = start.spin[i];
    const double r = start.radius[i];
    granules_.position[i] = {p[0], p[1], p[2], r};
    MotionRow& motion = granules_.motion[i];
    for (std::size_t k = 0; k < 3; ++k) {
      motion.velocity[k] = v[k] - frame[k];
      motion.surface_spin[k] = r * w[k];
    }
    motion.inverse_mass = 1.0 / start.mass[i];
    motion.inverse_radius = 1.0 / r;
    if (granules_.predicted.size() > 0) granules_.predicted[i] = motion;
    granules_.id[i] = static_cast<std::uint32_t>(i);
    granules_.population[i] = static_cast<std::uint8_t>(start.population[i]);
  }
  granules_.set_ghosts();
}

void Stepper::take_half_step_back() {
  // Forces at t = 0, with the velocities of t = 0, through one kick that is then halved and turned round.
  const EnclosureState at_start = motion_.initial_state();
  enclosure_ = at_start;
  rebuild_if_due();
  if (contact_effects_.counts()) trial(false, nullptr, true);
  results_.assign(list_.segments().size(), {});
  const Kernels& kernels = kernels_for(false);
  const SpringMemory springs = springs_;
  const double reaction = wall_forces(kernels);
  enclosure_ = motion_.start(reaction, wall_force());
  const Vector3 frame_change = motion_.velocity_change(at_start, enclosure_);
  const std::uint32_t count = granules_.count();
  RowArray<PositionRow> position = granules_.position.copy();
  RowArray<MotionRow> motion = granules_.motion.copy(), predicted = granules_.predicted.copy();
  Vector3 kick = plan_.scene.gravity;
  for (double& component : kick) component *= time_step_;
  boundary_forces(kernels);
  sweep(kernels, kick, {});
  springs_ = springs;
  granules_.position = std::move(position);
  for (std::uint32_t i = 0; i < count; ++i) {
    // There is no step before: nothing was lost in it, and nothing turned the granules.
    if (granules_.last_step.size() > 0) granules_.last_step[i] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      MotionRow &before = motion[i], &after = granules_.motion[i];
      const double gained = 0.5 * (after.velocity[k] - before.velocity[k]) + frame_change[k];
      const double spun = 0.5 * (after.surface_spin[k] - before.surface_spin[k]);
      before.velocity[k] -= gained;
      before.surface_spin[k] -= spun;
      if (granules_.last_step.size() > 0)
        granules_.last_step[i].velocity_rate[k] = static_cast<float>(gained / (0.5 * time_step_));
    }
  }
  granules_.motion = std::move(motion);
  granules_.predicted = std::move(predicted);
  granules_.wall_loss.clear(0, count);
  for (SegmentResult& result : results_)
    for (const kernels::ContactResult* contact : result.contacts()) {
      guards_.max_overlap = std::max(guards_.max_overlap, contact->max_overlap);
      guards_.max_closing = std::max(guards_.max_closing, contact->max_closing);
    }
}

} // namespace grandamp
