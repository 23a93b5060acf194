// How the enclosure moves: still, prescribed, or carried by the structure. The structure's state lives at half steps,
// t_(n-1/2), beside the granules' half-step velocities, so that both take the contact forces of t_n as a centred kick.
#pragma once

#include "solver/scene.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace grandamp {

class DrivenStructure;
class PiecewisePolynomial;

/// What one step of the enclosure gave. "At t_n": the middle of the interval from t_(n-1/2) to t_(n+1/2).
struct EnclosureStep {
  double velocity_before = 0.0; ///< V at t_(n-1/2), m/s
  double velocity_after = 0.0;  ///< V at t_(n+1/2), m/s
  double displacement = 0.0;    ///< X at t_n, m
  double velocity = 0.0; ///< V at t_n, m/s (a granule's laboratory velocity at t_n takes the mean of before and after)
  double excitation = 0.0;   ///< F at t_n, N (foundation in motion: K y + c y')
  double work_in = 0.0;      ///< by the excitation over the interval, J (prescribed: by whatever moves the enclosure,
                             ///< against the reaction)
  double damping_loss = 0.0; ///< c V^2 integrated over the interval (foundation in motion: V - y' for V), J
  double stored = 0.0;       ///< M V^2/2 + K X^2/2 at t_n (foundation in motion: X - y for X), J
  // The share that falls before t_n: a ledger from t_0 to t_n is the sum of the steps before n, plus the first half of
  // step n, less the first half of step 0 (which lies before t = 0).
  double work_in_first_half = 0.0;
  double damping_loss_first_half = 0.0;
};

/// The part of an EnclosureMotion that a checkpoint needs.
struct EnclosureState {
  double displacement = 0.0; ///< X at t_(n-1/2), m (prescribed motion: unused)
  double velocity = 0.0;     ///< V at t_(n-1/2), m/s (prescribed motion: of that half step)
};

/// Advances the structure by the exact solution of its linear equation over a step, the reaction held constant over the
/// step (any frequency, any step; resonance, no damping and no stiffness included). Prescribed motion: V at t_(n+1/2)
/// is (X(t_(n+1)) - X(t_n)) / dt, so that a free granule moves straight in the laboratory to rounding.
class EnclosureMotion {
public:
  /// Still if the scene has neither structure nor prescribed motion.
  EnclosureMotion(const Scene& scene, double time_step);

  bool moves() const noexcept { return kind_ != Kind::still; }
  const Vector3& direction() const noexcept { return direction_; }

  /// Velocity of the enclosure at t = 0 as the scene gives it, m/s.
  double initial_velocity() const noexcept;
  double initial_displacement() const noexcept;

  /// The state at t_(-1/2), from the scene's at t = 0 and the reaction at t = 0 (N): the exact solution backwards.
  EnclosureState start(double reaction) const;

  /// The interval about t_n = step_number * dt; `state` goes from t_(n-1/2) to t_(n+1/2). Nothing else is remembered.
  EnclosureStep advance(EnclosureState& state, std::int64_t step_number, double reaction) const;

private:
  enum class Kind { still, prescribed, table, structure, driven };

  /// What the exact solution does to (X, V dt, p, q, r) over an interval, p, q and r being the forces
  /// F0 sin(w t), F0 cos(w t) and R times dt^2 / M: all in metres, so that the numbers are of one kind.
  struct Propagator {
    std::array<double, 5> displacement{}; ///< X grows by this row times the vector
    std::array<double, 5> velocity{};     ///< V dt grows by this row times the vector
    std::array<double, 15> work{};        ///< quadratic form of the excitation's work, upper triangle by rows, J/m^2
    std::array<double, 15> loss{};        ///< and of the damping loss, J/m^2
  };

  void prepare_structure(const Scene& scene);
  void prepare_drive(const Scene& scene);
  double mean_table_velocity(std::int64_t step_number) const;
  void hold_against(double reaction, EnclosureStep& step) const;
  EnclosureStep advance_structure(EnclosureState& state, std::int64_t step_number, double reaction) const;
  EnclosureStep advance_driven(EnclosureState& state, std::int64_t step_number, double reaction) const;
  EnclosureStep advance_prescribed(EnclosureState& state, std::int64_t step_number, double reaction) const;
  EnclosureStep advance_table(EnclosureState& state, std::int64_t step_number, double reaction) const;

  Kind kind_ = Kind::still;
  Vector3 direction_{1.0, 0.0, 0.0};
  double time_step_ = 0.0;
  double initial_displacement_ = 0.0;
  double initial_velocity_ = 0.0;
  double mass_ = 0.0;
  double stiffness_ = 0.0;
  double damping_ = 0.0;
  double force_ = 0.0;           ///< amplitude of the harmonic force, N
  double cycles_per_step_ = 0.0; ///< frequency times time step
  double sine_half_ = 0.0;       ///< of half a step's phase
  double cosine_half_ = 1.0;
  double amplitude_ = 0.0;                        ///< of the prescribed motion, m
  double constant_velocity_ = 0.0;                ///< of the prescribed motion, m/s
  Propagator half_;                               ///< from t_(n-1/2) to t_n
  Propagator whole_;                              ///< from t_(n-1/2) to t_(n+1/2)
  std::array<double, 5> backward_displacement_{}; ///< from t_0 to t_(-1/2)
  std::array<double, 5> backward_velocity_{};
  std::shared_ptr<const DrivenStructure> driven_;    ///< what is no harmonic force
  std::shared_ptr<const PiecewisePolynomial> table_; ///< the enclosure's own motion, m
};

} // namespace grandamp
