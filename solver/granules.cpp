#include "solver/granules.hpp"

#include <cstring>

namespace grandamp {

namespace {
constexpr std::size_t ghosts = 2;

template <class T> void clear_rows(RowArray<T>& rows, std::uint32_t first, std::uint32_t last) {
  if (rows.size() > 0) std::memset(static_cast<void*>(rows.data() + first), 0, (last - first) * sizeof(T));
}
} // namespace

ForcesByKind::ForcesByKind(std::size_t rows)
    : damping_granule(rows), damping_wall(rows), friction_granule(rows), friction_wall(rows), touches_wall(rows) {
  clear(0, static_cast<std::uint32_t>(rows));
}

kernels::KindRows ForcesByKind::arrays() {
  return {damping_granule.data(), damping_wall.data(), friction_granule.data(), friction_wall.data(),
          touches_wall.data()};
}

void ForcesByKind::clear(std::uint32_t first, std::uint32_t last) {
  clear_rows(damping_granule, first, last);
  clear_rows(damping_wall, first, last);
  clear_rows(friction_granule, first, last);
  clear_rows(friction_wall, first, last);
  clear_rows(touches_wall, first, last);
}

void ForcesByKind::take(const ForcesByKind& from, const std::uint32_t* order, std::uint32_t first, std::uint32_t last) {
  if (damping_granule.size() == 0) return;
  for (std::uint32_t k = first; k < last; ++k) {
    damping_granule[k] = from.damping_granule[order[k]];
    friction_granule[k] = from.friction_granule[order[k]];
    touches_wall[k] = from.touches_wall[order[k]];
    damping_wall[k] = from.damping_wall[order[k]];
    friction_wall[k] = from.friction_wall[order[k]];
  }
}

ForcesByKind ForcesByKind::copy() const {
  ForcesByKind other;
  other.damping_granule = damping_granule.copy();
  other.damping_wall = damping_wall.copy();
  other.friction_granule = friction_granule.copy();
  other.friction_wall = friction_wall.copy();
  other.touches_wall = touches_wall.copy();
  return other;
}

Granules::Granules(std::size_t count, GranuleStorage storage)
    : position(count + ghosts), motion(count + ghosts), predicted(storage.predicted ? count + ghosts : 0),
      force(count + ghosts), id(count + ghosts), population(count + ghosts), kinds(storage.ledger ? count + ghosts : 0),
      kinds_before(storage.ledger ? count + ghosts : 0), acceleration(storage.ledger ? count + ghosts : 0),
      count_(static_cast<std::uint32_t>(count)), spare_position_(count + ghosts), spare_predicted_(predicted.size()),
      spare_id_(count + ghosts), spare_population_(count + ghosts), share_(storage.shares ? count + ghosts : 0),
      spare_share_(share_.size()), spare_acceleration_(acceleration.size()) {
  for (std::size_t i = 0; i < share_.size(); ++i) share_[i] = 0.5; // nothing has touched yet
  clear_forces(0, count_ + ghosts);
  clear_rows(acceleration, 0, count_ + ghosts);
}

kernels::GranuleArrays Granules::arrays() {
  kernels::GranuleArrays a;
  a.position = position.data();
  a.motion = motion.data();
  a.predicted = predicted.size() > 0 ? predicted.data() : motion.data();
  a.force = force.data();
  a.population = population.data();
  a.kinds = kinds.arrays();
  a.kinds_before = kinds_before.arrays();
  a.acceleration = acceleration.data();
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
  if (acceleration.size() > 0)
    for (std::uint32_t k = first; k < last; ++k) spare_acceleration_[k] = acceleration[order[k]];
  kinds.take(kinds_before, order, first, last);
}

void Granules::swap_permuted() {
  position.swap(spare_position_);
  id.swap(spare_id_);
  population.swap(spare_population_);
  predicted.swap(spare_predicted_);
  share_.swap(spare_share_);
  motion.swap_memory(force); // where permute() put the rows
  acceleration.swap(spare_acceleration_);
  age_kinds(); // permute() put the last step's into the place of this one's
  set_ghosts();
}

void Granules::clear_forces(std::uint32_t first, std::uint32_t last) {
  clear_rows(force, first, last);
  kinds.clear(first, last);
  if (share_.size() > 0)
    for (std::uint32_t i = first; i < last; ++i) force[i].friction_share = share_[i];
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
