// A whole run on the scalar oracle: every pair tried at every step, the structure by fine Runge-Kutta steps, nothing
// shared with the solver but the scene and the result types. Slow; for a few hundred granules.
#pragma once

#include "kernels/reference.hpp"
#include "solver/scene.hpp"
#include "solver/simulation.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace grandamp::test {

/// The enclosure's motion and what the excitation and the damper gave and took, in time.
struct ReferenceHost {
  double displacement = 0.0; ///< m
  double velocity = 0.0;     ///< m/s
  double work_in = 0.0;      ///< J
  double loss = 0.0;         ///< J
};

/// Structure, prescribed motion or neither. The structure's equation is integrated by Runge-Kutta substeps so fine that
/// their error is rounding.
class ReferenceEnclosure {
public:
  ReferenceEnclosure(const Scene& scene, double step);
  bool structure() const { return structure_.has_value(); }
  const Vector3& direction() const { return direction_; }
  double mass() const { return structure_ ? structure_->mass : 0.0; }
  double initial_velocity() const;
  ReferenceHost start(double reaction) const;
  /// From `from` to `to` (s; backwards if to < from), the reaction held.
  ReferenceHost advance_structure(ReferenceHost host, double from, double to, double reaction) const;
  double prescribed_displacement(double time) const;
  double prescribed_velocity(double time) const;
  double force(double time) const; ///< on the structure, N
  double stored(const ReferenceHost& host) const;

private:
  std::optional<Structure> structure_;
  Excitation excitation_;
  Vector3 direction_{1.0, 0.0, 0.0};
  double step_;
};

/// All granules must be placed (positions given).
class ReferenceRun {
public:
  ReferenceRun(const Scene& scene, double step);

  std::int64_t step_number() const { return state_.step_number; }
  double time() const { return static_cast<double>(state_.step_number) * step_; }
  void step() { advance(state_, nullptr); }
  void run(std::int64_t steps) {
    for (std::int64_t n = 0; n < steps; ++n) step();
  }
  /// The state now, velocities synchronised with positions; nothing moves.
  Sample sample() const;
  GranuleTable granules() const;
  /// Deepest overlap over the smaller radius met so far.
  double max_overlap() const { return state_.max_overlap; }

private:
  /// By granule, and partner or number of granules plus wall.
  using Springs = std::map<std::pair<std::size_t, std::size_t>, reference::Spring>;
  struct Touch {
    std::size_t i, j; ///< j == i: a wall
    std::size_t wall; ///< which
    reference::Contact contact;
  };
  struct State {
    std::int64_t step_number = 0;
    std::vector<reference::Granule> granules; ///< velocity relative to the enclosure, at t_(n-1/2)
    std::vector<reference::Vector> kick;      ///< the last change of velocity, m/s (Verlet's prediction, the ledger)
    std::vector<reference::Vector> spin_kick;
    ReferenceHost host; ///< at t_(n-1/2)
    Ledger ledger;
    double max_overlap = 0.0;
    Springs springs;                   ///< of the contacts in touch at t_(n-1)
    std::vector<Touch> touches_before; ///< those
  };
  struct Forces {
    std::vector<reference::Vector> force, torque;
    std::vector<Touch> touches;
    double reaction = 0.0, elastic = 0.0;
    reference::Vector wall_force{};                 ///< on the enclosure, N
    double spring_granule = 0.0, spring_wall = 0.0; ///< in tangential springs, J
  };

  static void count_touch(const Touch& touch, std::vector<reference::Granule>& granules);
  const reference::Law& pair_law(std::size_t i, std::size_t j) const;
  const reference::Law& wall_law(std::size_t i) const;
  /// Contact forces at the granules' positions, damping and slip from `moving`'s velocities and spins; `arrived` has
  /// those that brought the granules there, for the tangential springs (at the start nothing has loaded them).
  Forces forces(const std::vector<reference::Granule>& moving, const std::vector<reference::Granule>& arrived,
                const Springs& springs, bool at_start) const;
  /// One step; tells the state at its t_n if asked, granules with synchronised laboratory velocities.
  void advance(State& state, Sample* sample, std::vector<reference::Granule>* synchronised = nullptr) const;

  Scene scene_;
  double step_;
  bool rotation_ = false;
  ReferenceEnclosure enclosure_;
  std::size_t populations_;
  std::vector<reference::Law> pair_laws_, wall_laws_;
  double wall_slip_inverse_mass_ = 0.0; ///< the structure's part in the cap of a wall's friction, 1/kg
  std::vector<std::int32_t> population_;
  std::vector<reference::Granule> initial_; ///< velocities relative to the enclosure at t = 0
  State state_;
};

} // namespace grandamp::test
