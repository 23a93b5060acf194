#include "solver/driven_structure.hpp"

#include "solver/cycle_phase.hpp"
#include "solver/linear_solution.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace grandamp {

namespace {

using std::numbers::pi;
constexpr Eigen::Index cubic_size = 4, quintic_size = 6, sine_size = 2;

/// Gauss-Legendre on [0, 1], exact to the seventh degree.
constexpr std::array<double, 4> gauss_node{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                           0.93056815579702629};
constexpr std::array<double, 4> gauss_weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                             0.17392742256872693};

double norm_or_one(double norm) {
  return norm > 0.0 && std::isfinite(norm) ? norm : 1.0;
}

} // namespace

DrivenStructure::DrivenStructure(LinearStructure structure, Drive drive, double time_step)
    : structure_(std::move(structure)), drive_(std::move(drive)), size_(structure_.mass.rows()),
      reactions_(structure_.attachment.rows()) {
  drive_size_ = drive_.signal ? cubic_size : drive_.base_motion ? quintic_size : sine_size;
  choose_pieces(time_step);
  prepare();
}

/// So many that a piece is short against the structure's own periods and, for a table of motion, its rows. Powers of
/// two, so that instants keep their digits.
void DrivenStructure::choose_pieces(double time_step) {
  double longest = std::numeric_limits<double>::infinity();
  if (drive_.signal || drive_.base_motion) {
    const Eigen::MatrixXd own = structure_.mass.llt().solve(structure_.stiffness);
    const double fastest = std::sqrt(own.cwiseAbs().rowwise().sum().maxCoeff());
    if (fastest > 0.0) longest = 2.0 * pi / fastest / 16.0;
    if (drive_.frequency > 0.0) longest = std::min(longest, 1.0 / drive_.frequency / 16.0);
  }
  if (drive_.base_motion) {
    const std::vector<double>& knots = drive_.base_motion->knots();
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) longest = std::min(longest, knots[k + 1] - knots[k]);
  }
  constexpr std::int64_t most_pieces = 1 << 16;
  while (0.5 * time_step > longest * static_cast<double>(pieces_per_half_) && pieces_per_half_ < most_pieces)
    pieces_per_half_ *= 2;
  length_ = 0.5 * time_step / static_cast<double>(pieces_per_half_);
}

void DrivenStructure::prepare() {
  const Eigen::Index n = size_, first = 2 * n, reaction = first + drive_size_, all = reaction + reactions_;
  const double h = length_;
  const Eigen::LLT<Eigen::MatrixXd> mass = structure_.mass.llt();
  const Eigen::VectorXd push = mass.solve(structure_.force);
  const Eigen::MatrixXd hold = mass.solve(structure_.attachment.transpose());
  force_scale_ = h * h * norm_or_one(push.norm());
  reaction_scale_ = h * h * norm_or_one(hold.norm());

  // d/ds of the row, s = t / h.
  using Matrix = Eigen::MatrixXd;
  Matrix matrix = Matrix::Zero(all, all);
  matrix.block(0, n, n, n).setIdentity();
  matrix.block(n, 0, n, n) = -h * h * mass.solve(structure_.stiffness);
  matrix.block(n, n, n, n) = -h * mass.solve(structure_.damping);
  matrix.block(n, reaction, n, reactions_) = h * h / reaction_scale_ * hold;
  auto drive = matrix.block(first, first, drive_size_, drive_size_);
  if (drive_size_ == sine_size) {
    drive(0, 1) = 2.0 * pi * drive_.frequency * h;
    drive(1, 0) = -drive(0, 1);
  } else {
    for (Eigen::Index k = 0; k + 1 < drive_size_; ++k) drive(k, k + 1) = 1.0;
  }

  Matrix work = Matrix::Zero(all, all), loss = Matrix::Zero(all, all);
  if (drive_.by_base()) {
    // y is the first of what drives, and y' h what it grows by.
    Eigen::RowVectorXd y = Eigen::RowVectorXd::Zero(all), stretch = y;
    y(first) = 1.0;
    const Eigen::RowVectorXd rate = y * matrix;
    stretch(0) = -1.0;
    stretch += y;
    Eigen::RowVectorXd slip = rate;
    slip(n) -= 1.0;
    const double k = structure_.stiffness(0, 0), c = structure_.damping(0, 0);
    matrix.row(n) += h * h / structure_.mass(0, 0) * (k * y + c / h * rate);
    work = rate.transpose() * (k * stretch + c / h * slip); // (K (y - x) + c (y' - x')) y' dt
    work = (0.5 * (work + work.transpose())).eval();
    loss = c / h * slip.transpose() * slip;
  } else {
    matrix.block(n, first, n, 1) = h * h / force_scale_ * push;
    work.block(n, first, n, 1) = 0.5 / force_scale_ * structure_.force; // F force^T q' dt
    work.block(first, n, 1, n) = work.block(n, first, n, 1).transpose();
    loss.block(n, n, n, n) = structure_.damping / h;
  }
  const LinearSolution<Matrix> solution = solve_linear<Matrix>(matrix, work, loss);
  forward_ = solution.growth.topRows(first);
  drive_growth_ = solution.growth.block(first, first, drive_size_, drive_size_);
  work_ = solution.work;
  loss_ = solution.loss;
  backward_ = solve_linear<Matrix>(-matrix, Matrix::Zero(all, all), Matrix::Zero(all, all)).growth.topRows(first);
}

Instant DrivenStructure::at_piece(std::int64_t piece) const {
  const double number = static_cast<double>(piece), time = number * length_;
  return {time, std::fma(number, length_, -time)};
}

Jet DrivenStructure::base_at(std::int64_t piece) const {
  const Instant instant = at_piece(piece);
  if (drive_.base_motion) return drive_.base_motion->at(instant);
  if (drive_.base == 0.0) return {};
  const CyclePhase phase = phase_at(drive_.frequency * length_, static_cast<double>(piece));
  const double w = 2.0 * pi * drive_.frequency;
  return {drive_.base * phase.sine, drive_.base * w * phase.cosine, -drive_.base * w * w * phase.sine};
}

void DrivenStructure::put_drive(Row& row, std::int64_t piece) const {
  if (drive_.signal) return put_projection(row, piece);
  if (drive_.base_motion) return put_quintic(row, piece);
  const double amplitude = drive_.by_base() ? drive_.base : drive_.force * force_scale_;
  if (amplitude == 0.0) return;
  const CyclePhase phase = phase_at(drive_.frequency * length_, static_cast<double>(piece));
  row(2 * size_) = amplitude * phase.sine;
  row(2 * size_ + 1) = amplitude * phase.cosine;
}

/// The force's moments over the piece, on Legendre's polynomials; then as derivatives at the beginning, by s.
void DrivenStructure::put_projection(Row& row, std::int64_t piece) const {
  const Instant begin = at_piece(piece);
  const double base = begin.time, end = at_piece(piece + 1).time;
  std::array<double, 4> moment{};
  for (double from = base; from < end;) {
    const double to = std::min(drive_.signal->next_break(from), end);
    const double first = (from - base) / length_, share = (to - from) / length_;
    for (std::size_t k = 0; k < gauss_node.size(); ++k) {
      const double s = first + share * gauss_node[k];
      const double force = drive_.signal->at({base, begin.rest + s * length_});
      const double x = 2.0 * s - 1.0, weighted = share * gauss_weight[k] * force;
      moment[0] += weighted;
      moment[1] += 3.0 * weighted * x;
      moment[2] += 5.0 * weighted * (1.5 * x * x - 0.5);
      moment[3] += 7.0 * weighted * (2.5 * x * x - 1.5) * x;
    }
    from = to;
  }
  const Eigen::Index first = 2 * size_;
  row(first) = force_scale_ * (moment[0] - moment[1] + moment[2] - moment[3]);
  row(first + 1) = force_scale_ * (2.0 * moment[1] - 6.0 * moment[2] + 12.0 * moment[3]);
  row(first + 2) = force_scale_ * (12.0 * moment[2] - 60.0 * moment[3]);
  row(first + 3) = force_scale_ * 120.0 * moment[3];
}

void DrivenStructure::put_quintic(Row& row, std::int64_t piece) const {
  const double h = length_;
  const Jet a = base_at(piece), b = base_at(piece + 1);
  const double rate = a.rate * h, bend = a.acceleration * h * h;
  const double value_left = b.value - a.value - rate - 0.5 * bend;
  const double rate_left = b.rate * h - rate - bend;
  const double bend_left = b.acceleration * h * h - bend;
  const Eigen::Index first = 2 * size_;
  row(first) = a.value;
  row(first + 1) = rate;
  row(first + 2) = bend;
  row(first + 3) = 6.0 * (10.0 * value_left - 4.0 * rate_left + 0.5 * bend_left);
  row(first + 4) = 24.0 * (-15.0 * value_left + 7.0 * rate_left - bend_left);
  row(first + 5) = 120.0 * (6.0 * value_left - 3.0 * rate_left + 0.5 * bend_left);
}

DrivenStructure::Row DrivenStructure::row_of(const State& state, const Eigen::VectorXd& reaction) const {
  Row row = Row::Zero(forward_.cols());
  row.head(size_) = state.head(size_);
  row.segment(size_, size_) = length_ * state.tail(size_);
  row.tail(reactions_) = reaction_scale_ * reaction;
  return row;
}

DrivenWork DrivenStructure::advance(State& state, std::int64_t piece, const Eigen::VectorXd& reaction) const {
  Row row = row_of(state, reaction);
  put_drive(row, piece);
  const DrivenWork done{row.dot(work_ * row), row.dot(loss_ * row)};
  const State grown = forward_ * row;
  state.head(size_) += grown.head(size_);
  state.tail(size_) += grown.tail(size_) / length_;
  return done;
}

void DrivenStructure::go_back(State& state, std::int64_t piece, const Eigen::VectorXd& reaction) const {
  Row row = row_of(state, reaction);
  put_drive(row, piece);
  const Eigen::VectorXd drive = row.segment(2 * size_, drive_size_);
  row.segment(2 * size_, drive_size_) += drive_growth_ * drive;
  const State grown = backward_ * row;
  state.head(size_) += grown.head(size_);
  state.tail(size_) += grown.tail(size_) / length_;
}

double DrivenStructure::stored(const State& state, std::int64_t piece) const {
  State stretch = state.head(size_);
  if (drive_.by_base()) stretch(0) -= base_at(piece).value;
  const State velocity = state.tail(size_);
  return 0.5 * (velocity.dot(structure_.mass * velocity) + stretch.dot(structure_.stiffness * stretch));
}

double DrivenStructure::excitation(std::int64_t piece) const {
  if (drive_.signal) return drive_.signal->at(at_piece(piece));
  if (drive_.by_base()) {
    const Jet base = base_at(piece);
    return structure_.stiffness(0, 0) * base.value + structure_.damping(0, 0) * base.rate;
  }
  if (drive_.force == 0.0) return 0.0;
  return drive_.force * phase_at(drive_.frequency * length_, static_cast<double>(piece)).sine;
}

} // namespace grandamp
