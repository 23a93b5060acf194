#include "solver/stepper.hpp"

#include "solver/guards.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grandamp {

using kernels::ContactResult;
using kernels::MotionRow;
using kernels::PositionRow;

const Stepper::Kernels& Stepper::kernels_for(bool energies) const {
  return energies ? with_energies_ : plain_;
}

namespace {

constexpr std::array ledger_terms{&Ledger::work_in,     &Ledger::structural_damping, &Ledger::normal_granule,
                                  &Ledger::normal_wall, &Ledger::friction_granule,   &Ledger::friction_wall};

void add(Ledger& sum, const kernels::Losses& losses) {
  sum.normal_granule += losses.normal_granule;
  sum.normal_wall += losses.normal_wall;
  sum.friction_granule += losses.friction_granule;
  sum.friction_wall += losses.friction_wall;
}

/// What of step 0 lies before t = 0, and is no part of the run: energies, which tell more exactly, are not asked for
/// in every run.
Ledger before_the_start(const StepRecord& record) {
  Ledger half = record.early;
  for (const auto term :
       {&Ledger::normal_granule, &Ledger::normal_wall, &Ledger::friction_granule, &Ledger::friction_wall})
    half.*term = 0.5 * (record.dissipated.*term);
  return half;
}

} // namespace

Ledger Stepper::ledger_at(const StepRecord& record) const {
  Ledger sum = ledger_;
  if (step_number_ > 0)
    for (const auto term : ledger_terms) sum.*term += record.early.*term;
  // What friction took since t = 0, less what its springs would give back.
  sum.friction_granule -= record.spring_granule;
  sum.friction_wall -= record.spring_wall;
  return sum;
}

const StepRecord& Stepper::step(bool energies) {
  audit_due_ = true;
  const std::size_t level = review_.level_of(step_number_);
  if (level > 0) return step_in_parts(level, energies);
  part_number_ = step_number_;
  take_part(energies);
  ++step_number_;
  return record_;
}

void Stepper::take_part(bool energies) {
  rebuild_if_due();
  audit_if_due();
  record_ = advance(energies);
  ++kick_number_;
  const Ledger before = step_number_ == 0 ? before_the_start(record_) : Ledger{};
  for (const auto term : ledger_terms) ledger_.*term += record_.dissipated.*term - before.*term;
}

const StepRecord& Stepper::step_in_parts(std::size_t level, bool energies) {
  const std::int64_t parts = StepReview::parts[level];
  rebuild_if_due(); // where a sample would, before the granules are taken elsewhere
  part_ = time_step_ / static_cast<double>(parts);
  level_ = level;
  // Velocities are where the first part wants them, at t_(n-1/2), positions half a step less half a part too late.
  const double early = 0.5 * (time_step_ - part_);
  drift(-early);
  StepRecord middle;
  for (std::int64_t p = 0; p < parts; ++p) {
    part_number_ = parts * step_number_ - parts / 2 + p;
    take_part(energies && p == parts / 2);
    if (p == parts / 2) middle = record_;
  }
  drift(early);
  part_ = time_step_;
  level_ = 0;
  record_ = middle;
  ++step_number_;
  return record_;
}

void Stepper::drift(double time) {
  double fastest = 0.0;
  for (std::uint32_t i = 0; i < granules_.count(); ++i) {
    const double* v = granules_.motion[i].velocity;
    double* p = &granules_.position[i].x;
    for (int k = 0; k < 3; ++k) p[k] += time * v[k];
    fastest = std::max(fastest, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  age_list(std::sqrt(fastest), std::abs(time));
}

StepRecord Stepper::trial(bool energies, RowArray<MotionRow>* mean, bool keep_counts) {
  rebuild_if_due();
  auto position = granules_.position.copy();
  auto motion = granules_.motion.copy();
  auto predicted = granules_.predicted.copy();
  auto last_step = granules_.last_step.copy();
  WallLosses before = granules_.wall_loss_before.copy();
  const EnclosureState enclosure = enclosure_;
  const ListAge age = age_;
  const GuardStatistics guards = guards_;
  const StepReview review = review_;
  part_number_ = step_number_;
  const SpringMemory springs = springs_;
  granules_.keep_shares(0, granules_.count());

  const StepRecord record = advance(energies);

  if (mean != nullptr) {
    mean->reset(granules_.motion.size());
    for (std::uint32_t i = 0; i < granules_.count(); ++i) {
      MotionRow& row = (*mean)[i];
      row = motion[i];
      for (int k = 0; k < 3; ++k) {
        row.velocity[k] = 0.5 * (motion[i].velocity[k] + granules_.motion[i].velocity[k]);
        row.surface_spin[k] = 0.5 * (motion[i].surface_spin[k] + granules_.motion[i].surface_spin[k]);
      }
    }
  }
  granules_.position = std::move(position);
  granules_.motion = std::move(motion);
  granules_.predicted = std::move(predicted);
  granules_.last_step = std::move(last_step);
  granules_.wall_loss_before = std::move(before);
  enclosure_ = enclosure;
  age_ = age;
  guards_ = guards;
  review_ = review;
  springs_ = springs;
  if (!keep_counts) granules_.clear_forces(0, granules_.count());
  return record;
}

StepRecord Stepper::advance(bool energies) {
  const Kernels& kernels = kernels_for(energies);
  if (profile_ != nullptr) profile_->prepare(list_.segments().size());
  results_.assign(list_.segments().size(), {});
  for (SegmentResult& result : results_) {
    for (ContactResult* contact : result.contacts()) {
      contact->max_overlap = guards_.max_overlap;
      if (!review_.on()) contact->max_closing = guards_.max_closing;
    }
  }
  const double reaction = wall_forces(kernels);
  EnclosureStep enclosure;
  timed(profile_, Phase::structure, 0,
        [&] { enclosure = mover().advance(enclosure_, part_number_, reaction, wall_force()); });
  Vector3 kick = plan_.scene.gravity;
  for (std::size_t k = 0; k < 3; ++k) kick[k] = kick[k] * part_ - enclosure.velocity_change[k];
  boundary_forces(kernels);
  sweep(kernels, kick, enclosure.mean_velocity);
  granules_.age_losses();
  StepRecord record = collect(reaction, enclosure);
  record.until = ledger_at(record);
  return record;
}

double Stepper::wall_forces(const Kernels& kernels) {
  kernels::WallArguments shared;
  shared.granules = granules_.arrays();
  shared.law = wall_laws_.front();
  shared.laws = wall_laws_.data();
  shared.friction_inverse_mass = friction_inverse_mass_;
  shared.friction_cap = friction_cap_ * (time_step_ / part_);
  team_.each(list_.segments().size(), [&](std::size_t s) {
    Segment& segment = list_.segments()[s];
    kernels::WallArguments a = shared;
    a.touching = segment.touching_wall.data();
    timed(profile_, Phase::walls, s, [&] {
      for (std::size_t w = 0; w < walls_.size(); ++w) {
        if (segment.walls[w].count == 0) continue;
        a.surface = walls_[w].surface;
        a.enclosure_inverse_mass = wall_mobility_[w].inverse_mass;
        std::copy_n(wall_mobility_[w].direction.begin(), 3, a.direction);
        a.list = segment.walls[w].granules.data();
        a.count = segment.walls[w].count;
        if (remembers()) a.springs = spring_arguments(s, springs_.of(s).walls[w], 0, wall_spring_laws_);
        (walls_[w].side ? kernels.side : kernels.plane)(a, results_[s].walls);
      }
    });
  });
  double reaction = 0.0;
  for (const SegmentResult& result : results_)
    for (std::size_t k = 0; k < 3; ++k) reaction -= result.walls.force[k] * motion_.direction()[k];
  return reaction;
}

Vector3 Stepper::wall_force() const {
  Vector3 force{};
  for (const SegmentResult& result : results_)
    for (std::size_t k = 0; k < 3; ++k) force[k] -= result.walls.force[k];
  return force;
}

double Stepper::approach_share() const {
  return skin_ > 0.0 ? 2.0 * age_.travelled / skin_ : 1.0;
}

kernels::PairArguments Stepper::pair_arguments() {
  kernels::PairArguments a;
  a.granules = granules_.arrays();
  a.law = pair_laws_.front();
  a.laws = pair_laws_.data();
  a.populations = contacts_.populations;
  a.radius = plan_.largest_radius;
  a.mass = plan_.scene.populations.empty() ? 0.0 : 1.0 / granules_.motion[0].inverse_mass;
  a.friction_cap = friction_cap_ * (time_step_ / part_);
  return a;
}

kernels::SpringArguments Stepper::spring_arguments(std::size_t segment, SpringMemory::Rows& rows, std::size_t first,
                                                   const std::vector<kernels::SpringLawRow>& laws) {
  kernels::SpringArguments a = SpringMemory::arguments(rows, springs_.of(segment).slots, first, kick_number_);
  // What is in touch at t = 0 is not loaded yet.
  a.time_step = step_number_ > 0 ? part_ : 0.0;
  a.law = laws.front();
  a.laws = laws.data();
  return a;
}

bool Stepper::crosses_in_sweep(std::size_t segment) const noexcept {
  const std::size_t segments = list_.segments().size();
  return segment + 1 == segments || team_.group_of(segment, segments) == team_.group_of(segment + 1, segments);
}

void Stepper::boundary_forces(const Kernels& kernels) {
  if (team_.threads() == 1) return;
  const kernels::PairArguments shared = pair_arguments();
  team_.each(list_.segments().size(), [&](std::size_t s) {
    if (crosses_in_sweep(s)) return;
    for (std::size_t b = 0; b < list_.segments()[s].blocks.size(); ++b) boundary_forces_of(s, b, kernels, shared);
  });
}

void Stepper::boundary_forces_of(std::size_t s, std::size_t b, const Kernels& kernels,
                                 const kernels::PairArguments& shared) {
  Segment& segment = list_.segments()[s];
  const Block& block = segment.blocks[b];
  const std::size_t count = block.boundary.to_test(approach_share());
  if (count == 0) return;
  kernels::PairArguments a = shared;
  a.touching = segment.touching.data();
  a.pairs = segment.boundary.data() + block.boundary.first;
  a.count = count;
  if (touch_ahead_ && b + 1 < segment.blocks.size()) {
    const Block& next = segment.blocks[b + 1];
    a.ahead = {{next.beyond, {next.first, next.last}}};
  }
  if (remembers()) a.springs = spring_arguments(s, springs_.of(s).boundary, block.boundary.first, pair_spring_laws_);
  timed(profile_, Phase::pairs, s, [&] { kernels.pair(a, results_[s].boundary); });
}

void Stepper::sweep(const Kernels& kernels, const Vector3& kick, const Vector3& frame_velocity) {
  const double approach = approach_share();
  const kernels::PairArguments shared = pair_arguments(); // now, while no row is being written
  team_.each(list_.segments().size(), [&](std::size_t s) {
    Segment& segment = list_.segments()[s];
    kernels::PairArguments pairs = shared;
    pairs.touching = segment.touching.data();
    kernels::MotionArguments motion;
    motion.granules = pairs.granules;
    motion.time_step = part_;
    std::copy_n(kick.begin(), 3, motion.kick);
    std::copy_n(frame_velocity.begin(), 3, motion.frame_velocity);
    std::uint32_t touched = segment.first;
    std::size_t crossed = crosses_in_sweep(s) ? 0 : segment.blocks.size();
    for (std::size_t b = 0; b < segment.blocks.size(); ++b) {
      const Block& block = segment.blocks[b];
      // A row's forces are summed up in one order however many threads there are: walls, across, within.
      for (; crossed < segment.blocks.size() && segment.blocks[crossed].first < block.front; ++crossed)
        boundary_forces_of(s, crossed, kernels, shared);
      pairs.ahead = {};
      if (touch_ahead_ && b + 1 < segment.blocks.size()) {
        // Partners in the layer ahead come in no order that a processor would guess, and where a layer is larger than
        // its second-level cache the next block's own rows have left it again.
        const Block& next = segment.blocks[b + 1];
        pairs.ahead = {{{touched, next.ahead}, {next.first, next.last}}};
        touched = std::max(touched, next.ahead);
      }
      pairs.pairs = segment.inner.data() + block.inner.first;
      pairs.count = block.inner.to_test(approach);
      if (remembers()) pairs.springs = spring_arguments(s, springs_.of(s).inner, block.inner.first, pair_spring_laws_);
      timed(profile_, Phase::pairs, s, [&] { kernels.pair(pairs, results_[s].pairs); });
      motion.first = block.first;
      motion.last = block.last;
      timed(profile_, Phase::motion, s, [&] { kernels.motion(motion, results_[s].motion); });
    }
  });
}

StepRecord Stepper::collect(double reaction, const EnclosureStep& enclosure) {
  StepRecord record;
  record.enclosure = enclosure;
  record.reaction = reaction;
  record.dissipated.work_in = enclosure.work_in;
  record.dissipated.structural_damping = enclosure.damping_loss;
  record.early.work_in = enclosure.work_in_first_half;
  record.early.structural_damping = enclosure.damping_loss_first_half;
  double max_speed_squared = 0.0, sum_speed_squared = 0.0;
  for (SegmentResult& result : results_) {
    record.spring_granule += result.boundary.spring + result.pairs.spring;
    record.spring_wall += result.walls.spring;
    for (std::size_t k = 0; k < 3; ++k) record.wall_force[k] -= result.walls.force[k];
    record.kinetic += result.motion.kinetic;
    for (std::size_t k = 0; k < 3; ++k) record.mass_moment[k] += result.motion.mass_moment[k];
    add(record.dissipated, result.motion.lost);
    add(record.early, result.motion.early);
    for (const ContactResult* contact : result.contacts()) {
      record.elastic += contact->elastic + contact->spring;
      record.contacts += contact->contacts;
      guards_.max_overlap = std::max(guards_.max_overlap, contact->max_overlap);
      guards_.max_closing = std::max(guards_.max_closing, contact->max_closing);
      review_.met(contact->max_closing);
    }
    max_speed_squared = std::max(max_speed_squared, result.motion.max_speed_squared);
    sum_speed_squared += result.motion.sum_speed_squared;
  }
  const double max_speed = std::sqrt(max_speed_squared);
  guards_.max_speed = std::max(guards_.max_speed, max_speed);
  review_.met(max_speed);
  ++age_.steps;
  age_list(max_speed, part_);
  watch(sum_speed_squared);
  return record;
}

void Stepper::watch(double sum_speed_squared) {
  const GuardView view = this->view();
  if (!std::isfinite(sum_speed_squared)) throw not_finite(view, guards_.max_overlap);
  if (guards_.max_overlap > overlap_stop) throw too_deep(view, guards_.max_overlap);
  if (guards_.max_closing > closing_limit_) throw too_fast(view, guards_.max_closing);
  if (guards_.max_overlap > overlap_warning && !warned_overlap_) {
    warned_overlap_ = true;
    warnings_.push_back(deep_overlap_warning(view, guards_.max_overlap));
  }
  if (guards_.max_closing > plan_.impact_speed && !warned_closing_ && !review_.on()) {
    warned_closing_ = true;
    warnings_.push_back(closing_speed_warning(view, guards_.max_closing));
  }
}

// ---- the list ------------------------------------------------------------------------------------------------------

void Stepper::age_list(double max_speed, double time) {
  age_.travelled += max_speed * time;
  if (plan_.scene.verlet.policy != ListPolicy::displacement) return;
  double farthest = 0.0;
  for (std::uint32_t i = 0; i < granules_.count(); ++i) {
    const PositionRow &now = granules_.position[i], &then = built_at_[i];
    const double x = now.x - then.x, y = now.y - then.y, z = now.z - then.z;
    farthest = std::max(farthest, x * x + y * y + z * z);
  }
  age_.farthest = std::sqrt(farthest);
}

void Stepper::rebuild_if_due() {
  if (rebuild_due(plan_.scene.verlet, age_, skin_)) rebuild();
}

void Stepper::rebuild() {
  if (age_.built && granules_.count() > 0) {
    tuner_.note(static_cast<double>(list_.candidates()) / granules_.count(), age_.steps);
    if (tuner_.active) skin_ = tuner_.skin;
    build_steps_ += age_.steps;
  }
  std::vector<LoadedSpring> springs;
  if (remembers() && age_.built) springs = springs_.loaded(list_, granules_, kick_number_ - 1, team_);
  search_.skin = skin_;
  search_.cell_length = std::max(plan_.cell, 2.0 * search_.small_radius + skin_);
  if (plan_.scene.verlet.policy == ListPolicy::all_pairs)
    timed(profile_, Phase::build, 0, [&] { list_.build_from_all_pairs(granules_, walls_, search_); });
  else
    list_.build(granules_, size_, walls_, search_, team_, profile_);
  for (const Segment& segment : list_.segments()) guards_.escaped += static_cast<std::int64_t>(segment.outside.size());
  if (guards_.escaped > 0) throw escaped(view(), guards_.escaped);

  if (remembers()) springs_.spread(springs, list_, granules_, kick_number_ - 1, team_);
  ++builds_;
  if (granules_.count() > 0) candidates_sum_ += static_cast<double>(list_.candidates()) / granules_.count();
  age_ = {};
  age_.built = true;
  if (plan_.scene.verlet.policy == ListPolicy::predicted)
    age_.allowed = predicted_interval(plan_.scene.verlet, skin_, largest_laboratory_speed(), part_);
  if (plan_.scene.verlet.policy == ListPolicy::displacement) built_at_ = granules_.position.copy();
}

double Stepper::largest_laboratory_speed() const {
  double largest = 0.0;
  const Vector3 frame = motion_.velocity_of(enclosure_);
  for (std::uint32_t i = 0; i < granules_.count(); ++i) {
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = granules_.motion[i].velocity[k] + frame[k];
      square += v * v;
    }
    largest = std::max(largest, square);
  }
  return std::sqrt(largest);
}

void Stepper::audit_if_due() {
  const std::int64_t every = plan_.scene.verlet.audit;
  if (every > 0 && step_number_ % every == 0 && std::exchange(audit_due_, false))
    audit_.compare(granules_, list_, walls_, every);
}

VerletStatistics Stepper::verlet() const {
  VerletStatistics v;
  v.builds = builds_;
  v.mean_interval = builds_ > 1 ? static_cast<double>(build_steps_) / static_cast<double>(builds_ - 1)
                                : static_cast<double>(age_.steps);
  v.candidates_per_granule = builds_ > 0 ? candidates_sum_ / static_cast<double>(builds_) : 0.0;
  v.skin = skin_;
  v.audited = audit_.audited;
  v.missed = audit_.missed;
  v.missed_pair_steps = audit_.missed_pair_steps;
  return v;
}

std::vector<std::string> Stepper::take_warnings() {
  return std::exchange(warnings_, {});
}

} // namespace grandamp
