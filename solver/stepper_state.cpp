// All that a Stepper remembers, out and in.
#include "solver/list_state.hpp"
#include "solver/stepper.hpp"

#include <algorithm>
#include <cstring>

namespace grandamp {

using kernels::DampingRow;
using kernels::ForceRow;
using kernels::MotionRow;

namespace {

/// Calls use(rows, part, values) for all that a state holds of the granules in rows of three components.
template <class Rows, class State, class Use> void each_part(Rows& granules, State& s, Use use) {
  use(granules.motion, &MotionRow::velocity, s.velocity);
  use(granules.motion, &MotionRow::surface_spin, s.surface_spin);
  use(granules.predicted, &MotionRow::velocity, s.predicted_velocity);
  use(granules.predicted, &MotionRow::surface_spin, s.predicted_surface_spin);
}

/// Calls use(part, values) for all that the ledger remembers of the step before, part(row) being a LastStepRow's.
template <class State, class Use> void each_of_last_step(State& s, Use use) {
  use([](auto& row) { return row.loss.damping; }, s.damping_granule);
  use([](auto& row) { return row.loss.friction; }, s.friction_granule);
  use([](auto& row) { return row.velocity_rate; }, s.velocity_rate);
  use([](auto& row) { return row.surface_spin_rate; }, s.surface_spin_rate);
}

/// The same for what is held of the granules at walls alone.
template <class Losses, class State, class Use> void each_wall_part(Losses& losses, State& s, Use use) {
  use(losses.damping, &DampingRow::force, s.damping_wall);
  use(losses.friction, &ForceRow::force, s.friction_wall);
  use(losses.friction, &ForceRow::turn, s.friction_wall_turn);
}

std::vector<double> places_of(const RowArray<kernels::PositionRow>& rows, std::uint32_t count) {
  std::vector<double> values;
  values.reserve(3 * std::size_t{count});
  for (std::uint32_t i = 0; i < count; ++i) values.insert(values.end(), {rows[i].x, rows[i].y, rows[i].z});
  return values;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

bool fuses(kernels::InstructionSet isa) {
  return isa != kernels::InstructionSet::generic;
}

} // namespace

std::vector<double> Stepper::constants() const {
  std::vector<double> values{time_step_,     friction_cap_, enclosure_inverse_mass_, friction_inverse_mass_,
                             closing_limit_, tuner_.least,  tuner_.largest,          search_.largest_radius,
                             plan_.cell,     plan_.skin};
  for (const auto* laws : {&pair_laws_, &wall_laws_})
    for (const kernels::LawRow& law : *laws) values.insert(values.end(), {law.stiffness, law.damping, law.friction});
  for (const auto* laws : {&pair_spring_laws_, &wall_spring_laws_})
    for (const kernels::SpringLawRow& law : *laws) values.insert(values.end(), {law.stiffness, law.damping});
  // The enclosure's own motion from a state of its own, at steps far apart: sines and cosines of another mathematics
  // library, or exponentials of another Eigen, show here.
  EnclosureState state = motion_.initial_state();
  state.displacement += 1e-3;
  state.velocity += 1e-2;
  for (double& coordinate : state.modes) coordinate += 1e-3;
  for (std::int64_t k = 0; k < 64; ++k) {
    const EnclosureStep step = motion_.advance(state, 7919 * k, 0.25, {0.25, 0.125, -0.5});
    values.insert(values.end(), {step.displacement, step.velocity, step.velocity_after, step.excitation, step.work_in});
  }
  // A table is read anew when a run goes on, and may be another by then.
  const Excitation& excitation = plan_.scene.excitation;
  if (excitation.kind == ExcitationKind::table) {
    std::vector<double> sums(3, 0.0);
    for (std::size_t k = 0; k < excitation.times.size(); ++k) {
      sums[0] += excitation.times[k];
      sums[1] += excitation.values[k];
      sums[2] += static_cast<double>(k % 1009) * excitation.values[k];
    }
    values.insert(values.end(), sums.begin(), sums.end());
  }
  return values;
}

void Stepper::save(RunState& s) const {
  const std::uint32_t count = granules_.count();
  s.step_number = step_number_;
  s.time_step = time_step_;
  s.fused = fuses(isa_);
  s.same_sizes = same_sizes_;
  s.constants = constants();

  s.id.assign(granules_.id.data(), granules_.id.data() + count);
  s.population.assign(granules_.population.data(), granules_.population.data() + count);
  s.position = places_of(granules_.position, count);
  s.radius.resize(count);
  s.inverse_mass.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    s.radius[i] = granules_.position[i].radius;
    s.inverse_mass[i] = granules_.motion[i].inverse_mass;
  }
  each_part(granules_, s, [count](const auto& rows, auto part, std::vector<double>& values) {
    values.clear();
    if (rows.size() == 0) return;
    values.reserve(3 * std::size_t{count});
    for (std::uint32_t i = 0; i < count; ++i)
      values.insert(values.end(), std::begin(rows[i].*part), std::end(rows[i].*part));
  });
  each_of_last_step(s, [&](auto part, std::vector<float>& values) {
    values.clear();
    if (granules_.last_step.size() == 0) return;
    values.reserve(3 * std::size_t{count});
    for (std::uint32_t i = 0; i < count; ++i) {
      const float* const row = part(granules_.last_step[i]);
      values.insert(values.end(), row, row + 3);
    }
  });
  s.at_wall.clear();
  const WallLosses& losses = granules_.wall_loss_before;
  for (std::uint32_t i = 0; i < (losses.touches.size() > 0 ? count : 0); ++i)
    if (losses.touches[i] != 0) s.at_wall.push_back(i);
  each_wall_part(losses, s, [&s](const auto& rows, auto part, std::vector<double>& values) {
    values.clear();
    for (const std::uint32_t i : s.at_wall)
      values.insert(values.end(), std::begin(rows[i].*part), std::end(rows[i].*part));
  });
  s.friction_share.clear();
  if (contact_effects_.counts())
    for (std::uint32_t i = 0; i < count; ++i) s.friction_share.push_back(granules_.force[i].friction_share);

  s.list = state_of(list_, count);
  s.spring_contacts.clear();
  s.springs.clear();
  if (remembers() && age_.built)
    for (const LoadedSpring& spring : springs_.loaded(list_, granules_, kick_number_ - 1, team_)) {
      s.spring_contacts.insert(s.spring_contacts.end(), {spring.id, spring.partner});
      s.springs.insert(s.springs.end(), std::begin(spring.row.force), std::end(spring.row.force));
      s.springs.push_back(spring.row.root);
    }
  s.built_at = built_at_.size() > 0 ? places_of(built_at_, count) : std::vector<double>{};
  s.skin = skin_;
  s.list_age = age_.steps;
  s.list_travelled = age_.travelled;
  s.list_farthest = age_.farthest;
  s.list_allowed = age_.allowed;
  s.list_built = age_.built;
  s.tuner_skin = tuner_.skin;
  s.tuner_factor = tuner_.factor;
  s.tuner_last_cost = tuner_.last_cost;
  s.tuner_rebuilds = tuner_.rebuilds;
  s.tuner_steps = tuner_.steps;
  s.tuner_candidates = tuner_.candidates;
  s.builds = builds_;
  s.build_steps = build_steps_;
  s.candidates_sum = candidates_sum_;

  s.enclosure_displacement = enclosure_.displacement;
  s.enclosure_velocity = enclosure_.velocity;
  s.enclosure_modes = enclosure_.modes;
  s.ledger = ledger_;
  s.guards = guards_;
  s.warned_overlap = warned_overlap_;
  s.warned_closing = warned_closing_;
  const StepReview::State& review = review_.state();
  s.review_level = review.level;
  s.review_speed = review.speed;
  s.review_refined = review.refined;
  s.review_finest = review.finest;
  s.audited = audit_.audited;
  s.missed = audit_.missed;
  s.missed_pair_steps = audit_.missed_pair_steps;
  s.unlisted.clear();
  for (const auto& [first, second] : audit_.unlisted()) s.unlisted.insert(s.unlisted.end(), {first, second});
}

Stepper::Stepper(const Plan& plan, const RunState& s, kernels::InstructionSet isa, int threads)
    : Stepper(plan, s.same_sizes, isa, threads) {
  check_state(s, plan);
  if (s.fused != fuses(isa))
    throw StateError(s.fused ? "the run used kernels that fuse multiplications and additions (avx2, avx512)"
                             : "the run used the generic kernels");
  if (!same_bits(constants(), s.constants))
    throw StateError("this program, or the mathematics library of this machine, makes other constants of the scene");
  step_number_ = s.step_number;
  restore_granules(s);
  restore_list(s);
  enclosure_ = {s.enclosure_displacement, s.enclosure_velocity, s.enclosure_modes};
  ledger_ = s.ledger;
  guards_ = s.guards;
  warned_overlap_ = s.warned_overlap;
  warned_closing_ = s.warned_closing;
  review_.restore({s.review_level, s.review_speed, s.review_refined, s.review_finest});
  audit_.audited = s.audited;
  audit_.missed = s.missed;
  audit_.missed_pair_steps = s.missed_pair_steps;
  Audit::Contacts contacts;
  for (std::size_t k = 0; k + 1 < s.unlisted.size(); k += 2) contacts.emplace(s.unlisted[k], s.unlisted[k + 1]);
  audit_.restore_unlisted(std::move(contacts));
}

void Stepper::restore_granules(const RunState& s) {
  granules_ = Granules(s.id.size(), {.predicted = motion_effects_.integration == kernels::Integration::verlet,
                                     .ledger = plan_.scene.output.energy,
                                     .shares = contact_effects_.counts()});
  for (std::size_t i = 0; i < s.id.size(); ++i) {
    granules_.id[i] = s.id[i];
    granules_.population[i] = s.population[i];
    granules_.position[i] = {s.position[3 * i], s.position[3 * i + 1], s.position[3 * i + 2], s.radius[i]};
    MotionRow& row = granules_.motion[i];
    row.inverse_mass = s.inverse_mass[i];
    row.inverse_radius = 1.0 / s.radius[i];
    if (contact_effects_.counts()) granules_.force[i].friction_share = s.friction_share[i];
    if (granules_.predicted.size() > 0) granules_.predicted[i] = row;
  }
  each_part(granules_, s, [](auto& rows, auto part, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size() / 3; ++i)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, std::begin(rows[i].*part));
  });
  each_of_last_step(s, [this](auto part, const std::vector<float>& values) {
    for (std::size_t i = 0; i < values.size() / 3; ++i)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, part(granules_.last_step[i]));
  });
  for (const std::uint32_t i : s.at_wall) granules_.wall_loss_before.touches[i] = 1;
  each_wall_part(granules_.wall_loss_before, s, [&s](auto& rows, auto part, const std::vector<double>& values) {
    for (std::size_t k = 0; k < s.at_wall.size(); ++k)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(3 * k), 3, std::begin(rows[s.at_wall[k]].*part));
  });
  granules_.set_ghosts();
}

void Stepper::restore_springs(const RunState& s) {
  std::vector<LoadedSpring> springs(s.spring_contacts.size() / 2);
  if (s.spring_contacts.size() != 2 * springs.size() || s.springs.size() != 4 * springs.size())
    throw StateError("springs/contacts and springs/force are of different lengths");
  for (std::size_t k = 0; k < springs.size(); ++k) {
    springs[k].id = s.spring_contacts[2 * k];
    springs[k].partner = s.spring_contacts[2 * k + 1];
    if (springs[k].id >= granules_.count()) throw StateError("springs/contacts holds a granule that is none");
    std::copy_n(s.springs.begin() + static_cast<std::ptrdiff_t>(4 * k), 3, std::begin(springs[k].row.force));
    springs[k].row.root = s.springs[4 * k + 3];
  }
  springs_.spread(springs, list_, granules_, kick_number_ - 1, team_);
}

void Stepper::restore_list(const RunState& s) {
  restore(list_, s.list, granules_.count(), walls_.size());
  if (remembers()) restore_springs(s);
  skin_ = s.skin;
  age_ = {s.list_age, s.list_travelled, s.list_farthest, s.list_allowed, s.list_built};
  tuner_.skin = s.tuner_skin;
  tuner_.factor = s.tuner_factor;
  tuner_.last_cost = s.tuner_last_cost;
  tuner_.rebuilds = s.tuner_rebuilds;
  tuner_.steps = s.tuner_steps;
  tuner_.candidates = s.tuner_candidates;
  builds_ = s.builds;
  build_steps_ = s.build_steps;
  candidates_sum_ = s.candidates_sum;
  if (s.built_at.empty()) return;
  built_at_.reset(granules_.position.size());
  std::copy_n(granules_.position.data(), granules_.position.size(), built_at_.data());
  for (std::size_t i = 0; i < s.id.size(); ++i) {
    built_at_[i].x = s.built_at[3 * i];
    built_at_[i].y = s.built_at[3 * i + 1];
    built_at_[i].z = s.built_at[3 * i + 2];
  }
}

} // namespace grandamp
