// The granules' rows, in cell-sorted order, and who is who in them.
#pragma once

#include "kernels/arguments.hpp"
#include "solver/row_array.hpp"

#include <cstdint>
#include <utility>

namespace grandamp {

/// What the rows must hold besides position, motion and force.
struct GranuleStorage {
  bool predicted = false; ///< velocities predicted to the full step (verlet)
  bool ledger = false;    ///< forces by mechanism, and what it remembers of the step before
  bool shares = false;    ///< ForceRow::friction_share lasts from step to step
};

/// Walls' forces that take energy, for the ledger; empty without one. Rows that are not marked in `touches` are zero.
struct WallLosses {
  RowArray<kernels::DampingRow> damping;
  RowArray<kernels::ForceRow> friction;
  RowArray<std::uint8_t> touches;

  WallLosses() = default;
  explicit WallLosses(std::size_t rows);
  kernels::WallLossRows arrays();
  void clear(std::uint32_t first, std::uint32_t last);
  /// Row k, which must be zero, becomes what row order[k] of `from` is.
  void take(const WallLosses& from, const std::uint32_t* order, std::uint32_t first, std::uint32_t last);
  WallLosses copy() const;
};

/// Structure of arrays. Each array has two ghost rows at its end (kernels::GranuleArrays).
class Granules {
public:
  Granules() = default;
  Granules(std::size_t count, GranuleStorage storage);

  std::uint32_t count() const noexcept { return count_; }

  RowArray<kernels::PositionRow> position;
  RowArray<kernels::MotionRow> motion;
  RowArray<kernels::MotionRow> predicted; ///< empty under leapfrog
  RowArray<kernels::ForceRow> force;
  RowArray<std::uint32_t> id; ///< scene order, by row
  RowArray<std::uint8_t> population;
  RowArray<kernels::LossRow> loss;          ///< ledger only, zero between steps
  RowArray<kernels::LastStepRow> last_step; ///< ledger only
  WallLosses wall_loss, wall_loss_before;   ///< of this step, and of the one before

  kernels::GranuleArrays arrays();

  /// Before force rows serve as scratch: what clear_forces() puts back into them.
  void keep_shares(std::uint32_t first, std::uint32_t last);
  /// Row k becomes what row order[k] was. Force rows serve as scratch and hold nothing afterwards: clear_forces().
  void permute(const std::uint32_t* order, std::uint32_t first, std::uint32_t last);
  void swap_permuted();
  void clear_forces(std::uint32_t first, std::uint32_t last);
  /// After a step: its losses at walls are those of the step before.
  void age_losses() noexcept { std::swap(wall_loss, wall_loss_before); }
  /// Puts the two ghost rows in place.
  void set_ghosts();

private:
  std::uint32_t count_ = 0;
  RowArray<kernels::PositionRow> spare_position_;
  RowArray<kernels::MotionRow> spare_predicted_;
  RowArray<std::uint32_t> spare_id_;
  RowArray<std::uint8_t> spare_population_;
  RowArray<double> share_, spare_share_;
  RowArray<kernels::LastStepRow> spare_last_step_;
};

} // namespace grandamp
