#include "solver/granules.hpp"

#include <cstring>

namespace grandamp {

namespace {
constexpr std::size_t ghosts = 2;

template <class T> void clear_rows(RowArray<T>& rows, std::uint32_t first, std::uint32_t last) {
  if (rows.size() > 0) std::memset(static_cast<void*>(rows.data() + first), 0, (last - first) * sizeof(T));
}
} // namespace

WallLosses::WallLosses(std::size_t rows) : damping(rows), friction(rows), touches(rows) {
  const auto all = static_cast<std::uint32_t>(rows);
  clear_rows(damping, 0, all);
  clear_rows(friction, 0, all);
  clear_rows(touches, 0, all);
}

kernels::WallLossRows WallLosses::arrays() {
  return {damping.data(), friction.data(), touches.data()};
}

void WallLosses::clear(std::uint32_t first, std::uint32_t last) {
  if (touches.size() == 0) return;
  for (std::uint32_t i = first; i < last; ++i) {
    if (touches[i] == 0) continue;
    damping[i] = {};
    friction[i] = {};
    touches[i] = 0;
  }
}

void WallLosses::take(const WallLosses& from, const std::uint32_t* order, std::uint32_t first, std::uint32_t last) {
  if (touches.size() == 0) return;
  for (std::uint32_t k = first; k < last; ++k) {
    if (from.touches[order[k]] == 0) continue;
    damping[k] = from.damping[order[k]];
    friction[k] = from.friction[order[k]];
    touches[k] = 1;
  }
}

WallLosses WallLosses::copy() const {
  WallLosses other;
  other.damping = damping.copy();
  other.friction = friction.copy();
  other.touches = touches.copy();
  return other;
}

Granules::Granules(std::size_t count, GranuleStorage storage)
    : position(count + ghosts), motion(count + ghosts), predicted(storage.predicted ? count + ghosts : 0),
      force(count + ghosts), id(count + ghosts), population(count + ghosts), loss(storage.ledger ? count + ghosts : 0),
      last_step(loss.size()), wall_loss(loss.size()), wall_loss_before(loss.size()),
      count_(static_cast<std::uint32_t>(count)), spare_position_(count + ghosts), spare_predicted_(predicted.size()),
      spare_id_(count + ghosts), spare_population_(count + ghosts), share_(storage.shares ? count + ghosts : 0),
      spare_share_(share_.size()), spare_last_step_(last_step.size()) {
  for (std::size_t i = 0; i < share_.size(); ++i) share_[i] = 0.5; // nothing has touched yet
  clear_forces(0, count_ + ghosts);
  clear_rows(loss, 0, count_ + ghosts);
  clear_rows(last_step, 0, count_ + ghosts);
}

kernels::GranuleArrays Granules::arrays() {
  kernels::GranuleArrays a;
  a.position = position.data();
  a.motion = motion.data();
  a.predicted = predicted.size() > 0 ? predicted.data() : motion.data();
  a.force = force.data();
  a.population = population.data();
  a.loss = loss.data();
  a.last_step = last_step.data();
  a.wall_loss = wall_loss.arrays();
  a.wall_loss_before = wall_loss_before.arrays();
  a.ghost = count_;
  return a;
}

void Granules::keep_shares(std::uint32_t first, std::uint32_t last) {
  if (share_.size() > 0)
    for (std::uint32_t i = first; i < last; ++i) share_[i] = force[i].friction_share;
}

void Granules::permute(const std::uint32_t* order, std::uint32_t first, std::uint32_t last) {
  auto* spare_motion = reinterpret_cast<kernels::MotionRow*>(force.data());
  for (std::uint32_t k = first; k < last; ++k) {
    const std::uint32_t from = order[k];
    spare_position_[k] = position[from];
    spare_motion[k] = motion[from];
    spare_id_[k] = id[from];
    spare_population_[k] = population[from];
  }
  if (predicted.size() > 0)
    for (std::uint32_t k = first; k < last; ++k) spare_predicted_[k] = predicted[order[k]];
  if (share_.size() > 0)
    for (std::uint32_t k = first; k < last; ++k) spare_share_[k] = share_[order[k]];
  if (last_step.size() > 0)
    for (std::uint32_t k = first; k < last; ++k) spare_last_step_[k] = last_step[order[k]];
  wall_loss.take(wall_loss_before, order, first, last);
}

void Granules::swap_permuted() {
  position.swap(spare_position_);
  id.swap(spare_id_);
  population.swap(spare_population_);
  predicted.swap(spare_predicted_);
  share_.swap(spare_share_);
  motion.swap_memory(force); // where permute() put the rows
  last_step.swap(spare_last_step_);
  age_losses(); // permute() put the last step's into the place of this one's
  set_ghosts();
}

void Granules::clear_forces(std::uint32_t first, std::uint32_t last) {
  wall_loss.clear(first, last);
  if (share_.size() == 0) return clear_rows(force, first, last);
  for (std::uint32_t i = first; i < last; ++i) force[i] = {{0.0, 0.0, 0.0}, 0.0, {0.0, 0.0, 0.0}, share_[i]};
}

void Granules::set_ghosts() {
  for (std::uint32_t k = 0; k < ghosts; ++k) {
    const double far = 1e30 * (k + 1);
    position[count_ + k] = {far, far, far, 1e-3};
    motion[count_ + k] = {{0.0, 0.0, 0.0}, 1.0, {0.0, 0.0, 0.0}, 1e3};
    if (predicted.size() > 0) predicted[count_ + k] = motion[count_ + k];
    id[count_ + k] = count_ + k;
    population[count_ + k] = 0;
  }
}

} // namespace grandamp
