#include "solver/enclosure_motion.hpp"

#include "solver/cycle_phase.hpp"
#include "solver/driven_structure.hpp"
#include "solver/linear_solution.hpp"
#include "solver/measures.hpp"
#include "solver/several_modes.hpp"

#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;

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

/// What drives the structure, N or m.
Drive drive_of(const Scene& scene) {
  Drive drive;
  const ExcitationKind kind = scene.excitation.kind;
  const bool sine = kind == ExcitationKind::base || kind == ExcitationKind::harmonic;
  drive.frequency = sine ? scene.excitation.frequency : highest_frequency(scene.excitation);
  if (kind == ExcitationKind::harmonic) drive.force = driving_force(scene);
  drive.base = base_amplitude(scene);
  drive.signal = make_force_signal(scene);
  if (is_motion_table(scene.excitation)) drive.base_motion = make_motion(scene.excitation);
  return drive;
}

} // namespace

EnclosureMotion::EnclosureMotion(const Scene& scene, double time_step) : time_step_(time_step) {
  const double frequency = scene.excitation.kind == ExcitationKind::none ? 0.0 : scene.excitation.frequency;
  cycles_per_step_ = frequency * time_step;
  sine_half_ = std::sin(std::numbers::pi * cycles_per_step_);
  cosine_half_ = std::cos(std::numbers::pi * cycles_per_step_);
  if (grandamp::has_several_modes(scene)) {
    prepare_modes(scene);
  } else if (scene.structure) {
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
  } else if (is_motion_table(scene.excitation)) {
    kind_ = Kind::table;
    direction_ = scene.excitation.direction;
    table_ = std::make_shared<const PiecewisePolynomial>(make_motion(scene.excitation));
    const Jet first = table_->at({});
    initial_displacement_ = first.value;
    initial_velocity_ = first.rate;
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
  if (scene.excitation.kind != ExcitationKind::none && scene.excitation.kind != ExcitationKind::harmonic)
    return prepare_drive(scene);
  force_ = driving_force(scene);

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

  LinearSolution<Matrix5> solution = solve_linear<Matrix5>(0.5 * matrix, 0.5 * work, 0.5 * loss);
  half_ = {row_of(solution.growth, 0), row_of(solution.growth, 1), triangle_of(solution.work),
           triangle_of(solution.loss)};
  twice_as_long(solution);
  whole_ = {row_of(solution.growth, 0), row_of(solution.growth, 1), triangle_of(solution.work),
            triangle_of(solution.loss)};
  solution = solve_linear<Matrix5>(-0.5 * matrix, Matrix5::Zero(), Matrix5::Zero());
  backward_displacement_ = row_of(solution.growth, 0);
  backward_velocity_ = row_of(solution.growth, 1);
}

void EnclosureMotion::prepare_modes(const Scene& scene) {
  kind_ = Kind::modes;
  direction_ = scene.structure->direction;
  modes_ = std::make_shared<const SeveralModes>(scene.structure->modes);
  driven_ = std::make_shared<const DrivenStructure>(linear_structure(*modes_), drive_of(scene), time_step_);
  const Vector3 place = at_enclosure(modes_->displacement.data()), velocity = at_enclosure(modes_->velocity.data());
  for (std::size_t k = 0; k < 3; ++k) {
    initial_displacement_ += place[k] * direction_[k];
    initial_velocity_ += velocity[k] * direction_[k];
  }
}

void EnclosureMotion::prepare_drive(const Scene& scene) {
  kind_ = Kind::driven;
  const auto only = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
  driven_ = std::make_shared<const DrivenStructure>(
      LinearStructure{only(mass_), only(damping_), only(stiffness_), only(1.0), only(1.0)}, drive_of(scene),
      time_step_);
}

double EnclosureMotion::initial_velocity() const noexcept {
  return initial_velocity_;
}

double EnclosureMotion::initial_displacement() const noexcept {
  return initial_displacement_;
}

EnclosureState EnclosureMotion::start(double reaction, const Vector3& wall_force) const {
  switch (kind_) {
  case Kind::still:
    break;
  case Kind::prescribed:
    return {0.0, constant_velocity_ + 2.0 * amplitude_ / time_step_ * sine_half_ * cosine_half_};
  case Kind::table:
    return {0.0, mean_table_velocity(-1)};
  case Kind::driven: {
    DrivenStructure::State state = Eigen::Vector2d(initial_displacement_, initial_velocity_);
    const Eigen::VectorXd held = Eigen::VectorXd::Constant(1, reaction);
    for (std::int64_t k = 1; k <= driven_->pieces_per_half(); ++k) driven_->go_back(state, -k, held);
    return {state(0), state(1)};
  }
  case Kind::modes: {
    const auto now = initial_state().modes;
    DrivenStructure::State state = Eigen::Map<const Eigen::VectorXd>(now.data(), static_cast<Eigen::Index>(now.size()));
    const Eigen::VectorXd held = Eigen::Vector3d(wall_force[0], wall_force[1], wall_force[2]);
    for (std::int64_t k = 1; k <= driven_->pieces_per_half(); ++k) driven_->go_back(state, -k, held);
    return {0.0, 0.0, {state.begin(), state.end()}};
  }
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

EnclosureStep EnclosureMotion::advance(EnclosureState& state, std::int64_t step_number, double reaction,
                                       const Vector3& wall_force) const {
  if (kind_ == Kind::modes) return advance_modes(state, step_number, wall_force);
  EnclosureStep step = advance_along(state, step_number, reaction);
  for (std::size_t k = 0; k < 3; ++k) {
    step.place[k] = step.displacement * direction_[k];
    step.velocity_change[k] = (step.velocity_after - step.velocity_before) * direction_[k];
    step.mean_velocity[k] = 0.5 * (step.velocity_after + step.velocity_before) * direction_[k];
  }
  return step;
}

EnclosureState EnclosureMotion::initial_state() const {
  if (kind_ != Kind::modes) return {initial_displacement_, initial_velocity_};
  EnclosureState state;
  state.modes = modes_->displacement;
  state.modes.insert(state.modes.end(), modes_->velocity.begin(), modes_->velocity.end());
  return state;
}

Vector3 EnclosureMotion::at_enclosure(const double* coordinates) const {
  Vector3 sum{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < modes_->size; ++i) sum[k] += modes_->attachment[k * modes_->size + i] * coordinates[i];
  return sum;
}

Vector3 EnclosureMotion::velocity_of(const EnclosureState& state) const {
  if (kind_ == Kind::modes) return at_enclosure(state.modes.data() + modes_->size);
  return {state.velocity * direction_[0], state.velocity * direction_[1], state.velocity * direction_[2]};
}

Vector3 EnclosureMotion::velocity_change(const EnclosureState& from, const EnclosureState& to) const {
  if (kind_ == Kind::modes) {
    const Vector3 a = velocity_of(from), b = velocity_of(to);
    return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  }
  const double change = to.velocity - from.velocity;
  return {change * direction_[0], change * direction_[1], change * direction_[2]};
}

namespace {

/// Both halves of the interval about t_n, piece by piece; `look` sees the state between them.
template <class Look>
void through(const DrivenStructure& driven, DrivenStructure::State& now, std::int64_t step_number,
             const Eigen::VectorXd& held, EnclosureStep& step, const Look& look) {
  const std::int64_t pieces = driven.pieces_per_half(), middle = 2 * pieces * step_number;
  const auto over = [&](std::int64_t first) {
    for (std::int64_t piece = first; piece < first + pieces; ++piece) {
      const DrivenWork done = driven.advance(now, piece, held);
      step.work_in += done.work_in;
      step.damping_loss += done.loss;
    }
  };
  over(middle - pieces);
  step.work_in_first_half = step.work_in;
  step.damping_loss_first_half = step.damping_loss;
  step.excitation = driven.excitation(middle);
  step.stored = driven.stored(now, middle);
  look();
  over(middle);
}

} // namespace

EnclosureStep EnclosureMotion::advance_modes(EnclosureState& state, std::int64_t step_number,
                                             const Vector3& wall_force) const {
  const auto size = static_cast<Eigen::Index>(state.modes.size());
  const Eigen::VectorXd held = Eigen::Vector3d(wall_force[0], wall_force[1], wall_force[2]);
  DrivenStructure::State now = Eigen::Map<const Eigen::VectorXd>(state.modes.data(), size);
  const auto along = [&](const Vector3& a) {
    return a[0] * direction_[0] + a[1] * direction_[1] + a[2] * direction_[2];
  };
  EnclosureStep step;
  const Vector3 before = velocity_of(state);
  through(*driven_, now, step_number, held, step, [&] {
    step.place = at_enclosure(now.data());
    step.displacement = along(step.place);
    step.velocity = along(at_enclosure(now.data() + modes_->size));
  });
  Eigen::Map<Eigen::VectorXd>(state.modes.data(), size) = now;
  const Vector3 after = velocity_of(state);
  for (std::size_t k = 0; k < 3; ++k) {
    step.velocity_change[k] = after[k] - before[k];
    step.mean_velocity[k] = 0.5 * (after[k] + before[k]);
  }
  step.velocity_before = along(before);
  step.velocity_after = along(after);
  return step;
}

EnclosureStep EnclosureMotion::advance_along(EnclosureState& state, std::int64_t step_number, double reaction) const {
  switch (kind_) {
  case Kind::still:
  case Kind::modes:
    break;
  case Kind::prescribed:
    return advance_prescribed(state, step_number, reaction);
  case Kind::table:
    return advance_table(state, step_number, reaction);
  case Kind::driven:
    return advance_driven(state, step_number, reaction);
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
    const CyclePhase phase = phase_at(cycles_per_step_, static_cast<double>(step_number) - 0.5);
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
    const CyclePhase phase = phase_at(cycles_per_step_, steps);
    step.displacement += amplitude_ * phase.sine;
    step.velocity += amplitude_ * 2.0 * std::numbers::pi * (cycles_per_step_ / time_step_) * phase.cosine;
    // (X(t_(n+1)) - X(t_n)) / dt, the difference of sines as a product: nothing cancels.
    const double cosine_after = phase.cosine * cosine_half_ - phase.sine * sine_half_;
    step.velocity_after += 2.0 * amplitude_ / time_step_ * sine_half_ * cosine_after;
  }
  hold_against(reaction, step);
  state.velocity = step.velocity_after;
  return step;
}

/// What moves the enclosure holds it against the granules. The mean of the half-step velocities is the one that the
/// granules' own kinetic energy changes by: a push of R for dt on a wall of that velocity.
void EnclosureMotion::hold_against(double reaction, EnclosureStep& step) const {
  step.work_in = -reaction * 0.5 * (step.velocity_before + step.velocity_after) * time_step_;
  step.work_in_first_half = 0.5 * step.work_in;
}

/// (X(t_(n+1)) - X(t_n)) / dt, as the mean of the velocity: the difference would cancel. Where a knot lies between them
/// the mean is taken piece by piece.
double EnclosureMotion::mean_table_velocity(std::int64_t step_number) const {
  constexpr std::array<double, 3> node{-0.7745966692414834, 0.0, 0.7745966692414834}; // Gauss-Legendre
  constexpr std::array<double, 3> weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const std::vector<double>& knots = table_->knots();
  const double begin = static_cast<double>(step_number) * time_step_;
  const double end = static_cast<double>(step_number + 1) * time_step_;
  double sum = 0.0;
  for (double from = begin; from < end;) {
    const auto knot = std::upper_bound(knots.begin(), knots.end(), from);
    const double to = knot == knots.end() ? end : std::min(end, *knot);
    for (std::size_t k = 0; k < node.size(); ++k)
      sum += weight[k] * (to - from) * table_->at({from, 0.5 * (1.0 + node[k]) * (to - from)}).rate;
    from = to;
  }
  return sum / time_step_;
}

EnclosureStep EnclosureMotion::advance_table(EnclosureState& state, std::int64_t step_number, double reaction) const {
  const Jet now = table_->at({static_cast<double>(step_number) * time_step_, 0.0});
  EnclosureStep step;
  step.velocity_before = state.velocity;
  step.displacement = now.value;
  step.velocity = now.rate;
  step.velocity_after = mean_table_velocity(step_number);
  hold_against(reaction, step);
  state.velocity = step.velocity_after;
  return step;
}

EnclosureStep EnclosureMotion::advance_driven(EnclosureState& state, std::int64_t step_number, double reaction) const {
  const Eigen::VectorXd held = Eigen::VectorXd::Constant(1, reaction);
  DrivenStructure::State now = Eigen::Vector2d(state.displacement, state.velocity);
  EnclosureStep step;
  step.velocity_before = state.velocity;
  through(*driven_, now, step_number, held, step, [&] {
    step.displacement = now(0);
    step.velocity = now(1);
  });
  state = {now(0), now(1), {}};
  step.velocity_after = state.velocity;
  return step;
}

} // namespace grandamp
