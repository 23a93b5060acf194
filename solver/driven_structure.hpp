// A linear structure of any number of degrees of freedom, driven by a force or by its foundation's motion, advanced by
// its exact solution over pieces of a step.
#pragma once

#include "solver/excitation_signal.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

namespace grandamp {

/// M q'' + C q' + K q = force F(t) + attachment^T R, with n degrees of freedom; SI.
struct LinearStructure {
  Eigen::MatrixXd mass, damping, stiffness; ///< n x n, symmetric
  Eigen::MatrixXd attachment;               ///< k x n: the enclosure's displacement, by component, is attachment q
  Eigen::VectorXd force;                    ///< n: what a unit of force does to the equations
};

/// What drives it: one of them, or nothing.
struct Drive {
  double frequency = 0.0;                         ///< Hz, of the two below
  double force = 0.0;                             ///< amplitude of a harmonic force, N
  double base = 0.0;                              ///< amplitude of the foundation's sine, m
  std::shared_ptr<const ForceSignal> signal;      ///< any other force
  std::optional<PiecewisePolynomial> base_motion; ///< any other motion of the foundation, m

  bool by_base() const noexcept { return base != 0.0 || base_motion.has_value(); }
};

/// What happened over some pieces, J.
struct DrivenWork {
  double work_in = 0.0; ///< by the force; or by the foundation's motion against what spring and damper exert on it
  double loss = 0.0;    ///< in the damping: of q' relative to the foundation
};

/// A step is 2 * pieces_per_half() pieces, numbered from t = 0 on. Over a piece the solution is exact with the reaction
/// held, for sines. Any other force is put as its projection on cubics, whose error the solution does not feel (it is
/// orthogonal to what the response makes of a short piece), with jumps and kinks where they are; any other motion of
/// the foundation as the quintic that meets displacement, velocity and acceleration at both ends of the piece.
/// A moving foundation is for one degree of freedom.
class DrivenStructure {
public:
  /// Most degrees of freedom.
  static constexpr int most = 64;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * most, 1>; ///< q, then q'

  DrivenStructure(LinearStructure structure, Drive drive, double time_step);

  std::int64_t pieces_per_half() const noexcept { return pieces_per_half_; }
  /// Over the piece of that number, from its beginning to its end, under the reaction (N, k components).
  DrivenWork advance(State& state, std::int64_t piece, const Eigen::VectorXd& reaction) const;
  /// From its end to its beginning.
  void go_back(State& state, std::int64_t piece, const Eigen::VectorXd& reaction) const;
  /// Stored at the beginning of the piece, J.
  double stored(const State& state, std::int64_t piece) const;
  /// The force then, N; with a moving foundation K y + c y'.
  double excitation(std::int64_t piece) const;

private:
  /// q, q' times the length of a piece, what drives, the reaction: all scaled to metres.
  using Row = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * most + 12, 1>;

  void choose_pieces(double time_step);
  void prepare();
  Instant at_piece(std::int64_t piece) const;
  Jet base_at(std::int64_t piece) const;
  /// What drives at the beginning of the piece, and how it goes on over it.
  void put_drive(Row& row, std::int64_t piece) const;
  void put_projection(Row& row, std::int64_t piece) const;
  void put_quintic(Row& row, std::int64_t piece) const;
  Row row_of(const State& state, const Eigen::VectorXd& reaction) const;

  LinearStructure structure_;
  Drive drive_;
  Eigen::Index size_ = 0, drive_size_ = 0, reactions_ = 0;
  std::int64_t pieces_per_half_ = 1;
  double length_ = 0.0; ///< of a piece, s
  double force_scale_ = 1.0, reaction_scale_ = 1.0;
  Eigen::MatrixXd forward_, backward_; ///< what q and q' grow by over a piece, in rows
  Eigen::MatrixXd drive_growth_;
  Eigen::MatrixXd work_, loss_; ///< quadratic forms, J/m^2
};

} // namespace grandamp
