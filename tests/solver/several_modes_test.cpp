// A structure of several modes: closed forms, Eigen's eigenvalues and an independent integration, without granules; and
// energy, momentum and exactness with them.
#include "io/scene_file.hpp"
#include "solver/enclosure_motion.hpp"
#include "solver/run_state.hpp"
#include "solver/several_modes.hpp"
#include "tests/support/closed_form.hpp"
#include "tests/support/cut_runs.hpp"
#include "tests/support/momenta.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double pi = std::numbers::pi;

struct Mode {
  double mass, frequency, ratio;
  Vector3 shape;
  double force_shape;
  double displacement = 0.0, velocity = 0.0;
};

Structure plain(const Mode& mode) {
  const double w = 2.0 * pi * mode.frequency;
  return {.mass = mode.mass,
          .stiffness = mode.mass * w * w,
          .damping = 2.0 * mode.ratio * mode.mass * w,
          .displacement = mode.displacement,
          .velocity = mode.velocity};
}

void add_modes(Scene& scene, const std::vector<Mode>& modes) {
  scene.structure = Structure{};
  SeveralModes& all = scene.structure->modes;
  const std::size_t n = all.size = modes.size();
  for (auto* matrix : {&all.mass, &all.damping, &all.stiffness}) matrix->assign(n * n, 0.0);
  all.attachment.assign(3 * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const Structure one = plain(modes[i]);
    all.mass[i * n + i] = one.mass;
    all.damping[i * n + i] = one.damping;
    all.stiffness[i * n + i] = one.stiffness;
    for (std::size_t k = 0; k < 3; ++k) all.attachment[k * n + i] = modes[i].shape[k];
    all.force.push_back(modes[i].force_shape);
    all.displacement.push_back(modes[i].displacement);
    all.velocity.push_back(modes[i].velocity);
  }
}

const std::vector<Mode> two_modes{{0.1, 16.0, 0.01, {0.1, 0.0, 1.0}, 0.8, 1.0e-3, 0.02},
                                  {0.25, 41.0, 0.02, {0.7, 0.3, -0.4}, -0.5, -4.0e-4, 0.0}};

void force(Scene& scene, double amplitude, double frequency) {
  scene.excitation.kind = ExcitationKind::harmonic;
  scene.excitation.force = amplitude;
  scene.excitation.frequency = frequency;
}

/// Largest error of the enclosure's three displacements, over the largest of them; and what is left of the balance.
struct Outcome {
  double error = 0.0, unclosed = 0.0;
};

template <class Exact> Outcome run(const Scene& scene, double dt, int steps, const Exact& exact) {
  const EnclosureMotion motion(scene, dt);
  EnclosureState state = motion.start(0.0);
  Outcome outcome;
  double largest = 0.0, work = 0.0, loss = 0.0, first = 0.0, biggest = 0.0;
  for (int n = 0; n <= steps; ++n) {
    const EnclosureStep step = motion.advance(state, n, 0.0);
    const Vector3 wanted = exact(n * dt);
    for (std::size_t k = 0; k < 3; ++k) {
      largest = std::max(largest, std::abs(wanted[k]));
      outcome.error = std::max(outcome.error, std::abs(step.place[k] - wanted[k]));
    }
    if (n == 0) {
      first = step.stored;
      work = -step.work_in_first_half;
      loss = -step.damping_loss_first_half;
    }
    biggest = std::max({biggest, step.stored, std::abs(work)});
    outcome.unclosed = std::max(outcome.unclosed, std::abs(step.stored + loss + step.damping_loss_first_half - first -
                                                           work - step.work_in_first_half));
    work += step.work_in;
    loss += step.damping_loss;
  }
  outcome.error /= largest;
  outcome.unclosed /= biggest;
  return outcome;
}

/// A chain of two masses to a wall, the second one the enclosure in z, the force on the first; damping of any kind.
Scene chain(double damping_between) {
  Scene scene;
  scene.structure = Structure{};
  SeveralModes& m = scene.structure->modes;
  m.size = 2;
  m.mass = {0.2, 0.0, 0.0, 0.1};
  m.stiffness = {3000.0, -1000.0, -1000.0, 1000.0};
  m.damping = {0.3 + damping_between, -damping_between, -damping_between, damping_between};
  m.attachment = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  m.force = {1.0, 0.0};
  m.displacement = {1.0e-4, 2.0e-3};
  m.velocity = {0.0, -0.05};
  force(scene, 0.4, 14.0);
  return scene;
}

} // namespace

TEST_CASE("two modes without granules are the closed forms of each") {
  Scene scene;
  add_modes(scene, two_modes);
  force(scene, 0.6, 17.0);
  const auto exact = [&](double t) {
    Vector3 sum{};
    for (const Mode& mode : two_modes) {
      const double q = ClosedForm(plain(mode), 0.6 * mode.force_shape, 17.0).displacement(t);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += mode.shape[k] * q;
    }
    return sum;
  };
  for (const double dt : {1.0e-5, 1.0e-3, 2.0e-2}) {
    const Outcome outcome = run(scene, dt, static_cast<int>(std::lround(2.0 / dt)), exact);
    MESSAGE("error " << outcome.error << ", balance " << outcome.unclosed);
    CHECK(outcome.error < 1.0e-9);
    CHECK(outcome.unclosed < 1.0e-9);
  }
}

TEST_CASE("matrices with proportional damping are the modes of Eigen's generalised eigenvalues") {
  Scene scene = chain(0.0);
  SeveralModes& m = scene.structure->modes;
  for (std::size_t k = 0; k < 4; ++k) m.damping[k] = 0.5 * m.mass[k] + 2.0e-4 * m.stiffness[k];
  const LinearStructure s = linear_structure(m);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(s.stiffness, s.mass);
  const ModalNumbers numbers = modal_numbers(m);
  std::vector<ClosedForm> forms;
  std::vector<double> shapes;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Eigen::VectorXd shape = solver.eigenvectors().col(k); // of modal mass one
    const double square = solver.eigenvalues()(k);
    Structure one{.mass = 1.0, .stiffness = square, .damping = 0.5 + 2.0e-4 * square};
    one.displacement = shape.dot(s.mass * Eigen::Vector2d(m.displacement[0], m.displacement[1]));
    one.velocity = shape.dot(s.mass * Eigen::Vector2d(m.velocity[0], m.velocity[1]));
    forms.emplace_back(one, 0.4 * shape(0), 14.0);
    shapes.push_back(shape(1));
    CHECK(numbers.frequency[static_cast<std::size_t>(k)] == doctest::Approx(std::sqrt(square) / (2.0 * pi)));
    CHECK(numbers.damping_ratio[static_cast<std::size_t>(k)] ==
          doctest::Approx(one.damping / (2.0 * std::sqrt(square))));
  }
  CHECK(numbers.enclosure_mass == doctest::Approx(0.1));
  const Outcome outcome = run(scene, 5.0e-4, 4000, [&](double t) {
    return Vector3{0.0, 0.0, shapes[0] * forms[0].displacement(t) + shapes[1] * forms[1].displacement(t)};
  });
  MESSAGE("error " << outcome.error << ", balance " << outcome.unclosed);
  CHECK(outcome.error < 1.0e-9);
  CHECK(outcome.unclosed < 1.0e-9);
}

TEST_CASE("a damper between two masses, which no modes undo, against a fine integration, sine and chirp") {
  for (const bool chirp : {false, true}) {
    Scene scene = chain(2.5);
    if (chirp) {
      scene.excitation.kind = ExcitationKind::chirp;
      scene.excitation.start_frequency = 8.0;
      scene.excitation.end_frequency = 30.0;
      scene.excitation.sweep_duration = 2.0;
    }
    double x = 1.0e-4, y = 2.0e-3, u = 0.0, v = -0.05, at = 0.0;
    const auto rate = [&](double t, const std::array<double, 4>& s) {
      const double f = 0.4 * std::sin(2.0 * pi * (chirp ? 8.0 * t + 0.5 * 11.0 * t * t : 14.0 * t));
      return std::array<double, 4>{s[2], s[3], (f - 3000.0 * s[0] + 1000.0 * s[1] - 2.8 * s[2] + 2.5 * s[3]) / 0.2,
                                   (1000.0 * s[0] - 1000.0 * s[1] + 2.5 * s[2] - 2.5 * s[3]) / 0.1};
    };
    const auto step = [&](double h) {
      const std::array<double, 4> s{x, y, u, v};
      std::array<double, 4> k{}, sum{};
      for (const auto& [share, weight] : {std::pair{0.0, 1.0}, {0.5, 2.0}, {0.5, 2.0}, {1.0, 1.0}}) {
        std::array<double, 4> moved = s;
        for (std::size_t i = 0; i < 4; ++i) moved[i] += share * h * k[i];
        k = rate(at + share * h, moved);
        for (std::size_t i = 0; i < 4; ++i) sum[i] += weight * h / 6.0 * k[i];
      }
      x += sum[0];
      y += sum[1];
      u += sum[2];
      v += sum[3];
      at += h;
    };
    const Outcome outcome = run(scene, 1.0e-3, 2000, [&](double t) {
      if (t > 0.0)
        for (int n = 0; n < 20; ++n) step(5.0e-5);
      return Vector3{0.0, 0.0, y};
    });
    MESSAGE("error " << outcome.error << ", balance " << outcome.unclosed);
    CHECK(outcome.error < 1.0e-6);
    CHECK(outcome.unclosed < 1.0e-9);
  }
}

TEST_CASE("one mode is the structure of one degree of freedom - read as such, by the same bits") {
  const std::string head = "enclosure = {shape = \"box\", size = [1, 2, 3]}\ntime.duration = 1\n[structure]\n";
  const Structure one =
      read_scene_text(head + "modes = [{mass = 0.1, stiffness = 1000, damping = 0.2, shape = [0, 0, 1]}]\n", "one.toml")
          .scene.structure.value();
  CHECK(one.modes.size == 0);
  CHECK(one.mass == 0.1);
  CHECK(one.stiffness == 1000.0);
  CHECK(one.damping == 0.2);
  CHECK(one.direction == Vector3{0.0, 0.0, 1.0});
  // And where its shape is scaled otherwise, the same motion to rounding.
  Scene scene = bare_structure();
  const Structure s = *scene.structure;
  const ClosedForm exact(s, 0.5, 15.91);
  add_modes(scene, {{s.mass * 4.0, std::sqrt(s.stiffness / s.mass) / (2.0 * pi), 0.01, {0.0, 0.0, 2.0}, 2.0}});
  scene.excitation = {};
  force(scene, 0.5, 15.91);
  const Outcome outcome = run(scene, 1.0e-3, 3000, [&](double t) { return Vector3{0.0, 0.0, exact.displacement(t)}; });
  CHECK(outcome.error < 1.0e-9);
}

TEST_CASE("a box free to move in three directions keeps the momentum of all") {
  Scene scene = gas(100, 0.022, 1.0, 41);
  add_modes(scene, {{0.03, 0.0, 0.0, {1.0, 0.0, 0.0}, 0.0, 0.0, 0.3},
                    {0.03, 0.0, 0.0, {0.0, 1.0, 0.0}, 0.0, 0.0, -0.2},
                    {0.03, 0.0, 0.0, {0.0, 0.0, 1.0}, 0.0}});
  scene.time.duration = 8.0e-3;
  use_step(scene, shortest_contact_duration(scene, 3.0) / 8.0);
  SolverRun run(scene);
  const std::vector<double> masses(100, scene.populations[0].mass);
  const auto total = [&] {
    Vector3 sum = momenta(run.granules(), masses).linear;
    const std::vector<double> q = run.simulation().state().enclosure_modes;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += 0.03 * q[3 + k];
    return sum;
  };
  const Sample start = run.sample();
  const Vector3 before = total();
  run_all(run, scene);
  const Vector3 after = total();
  const Momenta scale = momenta(run.granules(), masses);
  CHECK(run.simulation().state().enclosure_modes[5] != 0.0);
  // The enclosure's velocity is that of half a step before, the granules' of the instant: a step's reaction apart.
  const Sample end = run.sample();
  const double step = run.time_step();
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(std::abs(after[k] + 0.5 * step * end.wall_force[k] - before[k] - 0.5 * step * start.wall_force[k]) <
          1.0e-9 * scale.linear_scale);
  CHECK(std::abs(ledger_residual(start, end)) < 0.01);
}

TEST_CASE("two modes that granules damp: the ledger closes within one percent") {
  for (const bool forced : {true, false}) {
    Scene scene = vertical_damper(60, 1.85e-3, 15.91, 0.12);
    scene.enclosure.size[2] = 0.02;
    add_modes(scene, two_modes);
    scene.excitation = {};
    if (forced)
      force(scene, 4.0, 17.0);
    else
      scene.structure->modes.velocity = {0.6, 0.4};
    use_step(scene, shortest_contact_duration(scene, 2.0) / 16.0);
    SolverRun run(scene);
    const Sample start = run.sample();
    run_all(run, scene);
    const Sample end = run.sample();
    MESSAGE("work in " << end.ledger.work_in << " J, residual " << 100.0 * ledger_residual(start, end) << " %");
    CHECK(end.ledger.normal_wall > 0.0);
    CHECK(end.ledger.structural_damping > 0.0);
    CHECK(std::abs(ledger_residual(start, end)) < 0.01);
  }
}

TEST_CASE("a state put back goes on by the same bits: two modes in a box, three in a cylinder") {
  Scene scene = vertical_damper(60, 1.85e-3, 15.91, 1.0);
  scene.time.step = 1.0e-5;
  add_modes(scene, two_modes);
  scene.excitation = {};
  force(scene, 4.0, 17.0);
  check_cut(scene, 3000, 5);
  Scene round = gas(80, 0.03, 1.0, 9);
  round.enclosure.shape = EnclosureShape::cylinder;
  round.enclosure.diameter = 0.05;
  round.enclosure.height = 0.03;
  for (Vector3& p : round.populations[0].positions) p = {p[0] + 0.01, p[1] + 0.01, p[2]};
  add_modes(round, {{0.1, 16.0, 0.01, {1.0, 0.0, 0.0}, 1.0, 0.0, 0.5},
                    {0.1, 21.0, 0.01, {0.0, 1.0, 0.0}, 1.0, 0.0, 0.5},
                    {0.2, 33.0, 0.01, {0.0, 0.2, 1.0}, 1.0, 0.0, 0.5}});
  round.excitation.kind = ExcitationKind::random;
  round.excitation.force_rms = 1.0;
  round.excitation.band = {10.0, 500.0};
  round.time.step = 3.0e-6;
  round.time.impact_speed = 5.0;
  check_cut(round, 3000, 5, 1, 2);
}
