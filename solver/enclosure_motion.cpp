#include "solver/enclosure_motion.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

/// The exact solution over an interval: y goes to y + growth y, and integrals of quadratic forms along the way.
struct Solution {
  Matrix5 growth; ///< exp(A s) - I: kept without the I, which would cost the small entries their digits
  Matrix5 work;
  Matrix5 loss;
};

/// exp(A) - I = A phi(A), phi being the upper right block of exp([[A, I], [0, 0]]). Every entry is then good to
/// rounding of its own size: over millions of short steps, exp(A) itself would lose the phase.
Matrix5 exponential_less_one(const Matrix5& matrix) {
  Eigen::Matrix<double, 10, 10> block = Eigen::Matrix<double, 10, 10>::Zero();
  block.topLeftCorner<5, 5>() = matrix;
  block.topRightCorner<5, 5>().setIdentity();
  const Eigen::Matrix<double, 10, 10> exponential = block.exp();
  return matrix * exponential.topRightCorner<5, 5>();
}

/// Integral over [0, 1] of exp(A s)^T form exp(A s), for small A: six-point Gauss-Legendre, exact to rounding.
Matrix5 integral_of(const Matrix5& form, const Matrix5& matrix) {
  constexpr std::array<double, 3> node{0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  constexpr std::array<double, 3> weight{0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  Matrix5 sum = Matrix5::Zero();
  for (std::size_t k = 0; k < node.size(); ++k)
    for (const double sign : {-1.0, 1.0}) {
      const Matrix5 there = Matrix5(0.5 * (1.0 + sign * node[k]) * matrix).exp();
      sum += 0.5 * weight[k] * there.transpose() * form * there;
    }
  return sum;
}

void twice_as_long(Solution& solution) {
  const Matrix5 whole = Matrix5::Identity() + solution.growth;
  solution.work = (solution.work + whole.transpose() * solution.work * whole).eval();
  solution.loss = (solution.loss + whole.transpose() * solution.loss * whole).eval();
  solution.growth = (2.0 * solution.growth + solution.growth * solution.growth).eval();
}

/// Starts from a piece so short that the matrix is small, and doubles it: no frequency and no damping is too large.
Solution solve(const Matrix5& matrix, const Matrix5& work, const Matrix5& loss) {
  int doublings = 0;
  for (double norm = matrix.lpNorm<Eigen::Infinity>(); norm > 0.25 && doublings < 60; norm *= 0.5) ++doublings;
  const double share = std::ldexp(1.0, -doublings);
  const Matrix5 piece = share * matrix;
  Solution solution{exponential_less_one(piece), share * integral_of(work, piece), share * integral_of(loss, piece)};
  for (int k = 0; k < doublings; ++k) twice_as_long(solution);
  return solution;
}

std::array<double, 5> row_of(const Matrix5& matrix, int row) {
  std::array<double, 5> values{};
  for (int k = 0; k < 5; ++k) values[static_cast<std::size_t>(k)] = matrix(row, k);
  return values;
}

/// Upper triangle of a symmetric form, the terms off the diagonal counted twice.
std::array<double, 15> triangle_of(const Matrix5& form) {
  std::array<double, 15> values{};
  std::size_t next = 0;
  for (int i = 0; i < 5; ++i)
    for (int k = i; k < 5; ++k) values[next++] = i == k ? form(i, i) : form(i, k) + form(k, i);
  return values;
}

double row_times(const std::array<double, 5>& row, const std::array<double, 5>& y) {
  return row[0] * y[0] + row[1] * y[1] + row[2] * y[2] + row[3] * y[3] + row[4] * y[4];
}

double form_at(const std::array<double, 15>& form, const std::array<double, 5>& y) {
  double sum = 0.0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t k = i; k < 5; ++k) sum += form[next++] * y[i] * y[k];
  return sum;
}

struct SineCosine {
  double sine;
  double cosine;
};

/// Of 2 pi times cycles_per_step times `steps`. The product is formed with its rounding error, and whole cycles are
/// dropped before the angle is taken: as good after 10^9 cycles as in the first.
SineCosine phase_at(double cycles_per_step, double steps) {
  const double product = cycles_per_step * steps;
  const double error = std::fma(cycles_per_step, steps, -product);
  const double angle = 2.0 * std::numbers::pi * ((product - std::floor(product)) + error);
  return {std::sin(angle), std::cos(angle)};
}

} // namespace

EnclosureMotion::EnclosureMotion(const Scene& scene, double time_step) : time_step_(time_step) {
  const double frequency = scene.excitation.kind == ExcitationKind::none ? 0.0 : scene.excitation.frequency;
  cycles_per_step_ = frequency * time_step;
  sine_half_ = std::sin(std::numbers::pi * cycles_per_step_);
  cosine_half_ = std::cos(std::numbers::pi * cycles_per_step_);
  if (scene.structure) {
    kind_ = Kind::structure;
    prepare_structure(scene);
  } else if (scene.excitation.kind == ExcitationKind::prescribed) {
    kind_ = Kind::prescribed;
    direction_ = scene.excitation.direction;
    if (scene.excitation.velocity)
      constant_velocity_ = *scene.excitation.velocity;
    else
      amplitude_ = scene.excitation.amplitude;
    initial_velocity_ = constant_velocity_ + amplitude_ * 2.0 * std::numbers::pi * frequency;
  }
}

void EnclosureMotion::prepare_structure(const Scene& scene) {
  const Structure& structure = *scene.structure;
  direction_ = structure.direction;
  initial_displacement_ = structure.displacement;
  initial_velocity_ = structure.velocity;
  mass_ = structure.mass;
  stiffness_ = structure.stiffness;
  damping_ = structure.damping;
  if (scene.excitation.kind == ExcitationKind::harmonic)
    force_ = scene.excitation.force.value_or(stiffness_ * scene.excitation.static_deflection.value_or(0.0));

  // d/ds of (X, V dt, p, q, r) with s = t / dt.
  const double h = time_step_;
  const double angle = 2.0 * std::numbers::pi * cycles_per_step_;
  Matrix5 matrix = Matrix5::Zero();
  matrix(0, 1) = 1.0;
  matrix(1, 0) = -stiffness_ * h * h / mass_;
  matrix(1, 1) = -damping_ * h / mass_;
  matrix(1, 2) = 1.0;
  matrix(1, 4) = 1.0;
  matrix(2, 3) = angle;
  matrix(3, 2) = -angle;
  Matrix5 work = Matrix5::Zero(); // F V dt = (M / dt^2) p (V dt) ds
  work(1, 2) = work(2, 1) = 0.5 * mass_ / (h * h);
  Matrix5 loss = Matrix5::Zero(); // c V^2 dt = (c / dt) (V dt)^2 ds
  loss(1, 1) = damping_ / h;

  Solution solution = solve(0.5 * matrix, 0.5 * work, 0.5 * loss);
  half_ = {row_of(solution.growth, 0), row_of(solution.growth, 1), triangle_of(solution.work),
           triangle_of(solution.loss)};
  twice_as_long(solution);
  whole_ = {row_of(solution.growth, 0), row_of(solution.growth, 1), triangle_of(solution.work),
            triangle_of(solution.loss)};
  solution = solve(-0.5 * matrix, Matrix5::Zero(), Matrix5::Zero());
  backward_displacement_ = row_of(solution.growth, 0);
  backward_velocity_ = row_of(solution.growth, 1);
}

double EnclosureMotion::initial_velocity() const noexcept {
  return initial_velocity_;
}

double EnclosureMotion::initial_displacement() const noexcept {
  return initial_displacement_;
}

EnclosureState EnclosureMotion::start(double reaction) const {
  switch (kind_) {
  case Kind::still:
    break;
  case Kind::prescribed:
    return {0.0, constant_velocity_ + 2.0 * amplitude_ / time_step_ * sine_half_ * cosine_half_};
  case Kind::structure: {
    const double scale = time_step_ * time_step_ / mass_;
    const std::array<double, 5> y{initial_displacement_, initial_velocity_ * time_step_, 0.0, force_ * scale,
                                  reaction * scale};
    return {initial_displacement_ + row_times(backward_displacement_, y),
            initial_velocity_ + row_times(backward_velocity_, y) / time_step_};
  }
  }
  return {};
}

EnclosureStep EnclosureMotion::advance(EnclosureState& state, std::int64_t step_number, double reaction) const {
  switch (kind_) {
  case Kind::still:
    break;
  case Kind::prescribed:
    return advance_prescribed(state, step_number, reaction);
  case Kind::structure:
    return advance_structure(state, step_number, reaction);
  }
  return {};
}

EnclosureStep EnclosureMotion::advance_structure(EnclosureState& state, std::int64_t step_number,
                                                 double reaction) const {
  const double scale = time_step_ * time_step_ / mass_;
  std::array<double, 5> y{state.displacement, state.velocity * time_step_, 0.0, 0.0, reaction * scale};
  EnclosureStep step;
  if (force_ != 0.0) {
    const SineCosine phase = phase_at(cycles_per_step_, static_cast<double>(step_number) - 0.5);
    y[2] = force_ * scale * phase.sine;
    y[3] = force_ * scale * phase.cosine;
    step.excitation = force_ * (phase.sine * cosine_half_ + phase.cosine * sine_half_);
    step.work_in = form_at(whole_.work, y);
    step.work_in_first_half = form_at(half_.work, y);
  }
  if (damping_ != 0.0) {
    step.damping_loss = form_at(whole_.loss, y);
    step.damping_loss_first_half = form_at(half_.loss, y);
  }
  step.velocity_before = state.velocity;
  step.displacement = state.displacement + row_times(half_.displacement, y);
  step.velocity = state.velocity + row_times(half_.velocity, y) / time_step_;
  step.stored = 0.5 * (mass_ * step.velocity * step.velocity + stiffness_ * step.displacement * step.displacement);
  state.displacement += row_times(whole_.displacement, y);
  state.velocity += row_times(whole_.velocity, y) / time_step_;
  step.velocity_after = state.velocity;
  return step;
}

EnclosureStep EnclosureMotion::advance_prescribed(EnclosureState& state, std::int64_t step_number,
                                                  double reaction) const {
  const double steps = static_cast<double>(step_number);
  EnclosureStep step;
  step.velocity_before = state.velocity;
  step.displacement = constant_velocity_ * (steps * time_step_);
  step.velocity = step.velocity_after = constant_velocity_;
  if (amplitude_ != 0.0) {
    const SineCosine phase = phase_at(cycles_per_step_, steps);
    step.displacement += amplitude_ * phase.sine;
    step.velocity += amplitude_ * 2.0 * std::numbers::pi * (cycles_per_step_ / time_step_) * phase.cosine;
    // (X(t_(n+1)) - X(t_n)) / dt, the difference of sines as a product: nothing cancels.
    const double cosine_after = phase.cosine * cosine_half_ - phase.sine * sine_half_;
    step.velocity_after += 2.0 * amplitude_ / time_step_ * sine_half_ * cosine_after;
  }
  state.velocity = step.velocity_after;
  // What moves the enclosure holds it against the granules. The mean of the half-step velocities is the one that the
  // granules' own kinetic energy changes by: a push of R for dt on a wall of that velocity.
  step.work_in = -reaction * 0.5 * (step.velocity_before + step.velocity_after) * time_step_;
  step.work_in_first_half = 0.5 * step.work_in;
  return step;
}

} // namespace grandamp
