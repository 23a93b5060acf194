// The bare structure against the closed forms of a single degree of freedom, and the balance of its energies.
#include "solver/enclosure_motion.hpp"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace grandamp;

namespace {

constexpr double pi = std::numbers::pi;

struct Exact {
  double displacement;
  double velocity;
};

/// M x'' + c x' + K x = F0 sin(w t), underdamped or overdamped, from (x0, v0). Long double, so that it is the
/// reference.
Exact closed_form(const Structure& s, double force, double frequency, double time) {
  using Real = long double;
  const Real m = s.mass, c = s.damping, k = s.stiffness, w = 2 * std::numbers::pi_v<Real> * frequency, t = time;
  const Real in_phase = k - m * w * w, out = c * w, square = in_phase * in_phase + out * out;
  const Real a = force == 0.0 ? 0 : force * in_phase / square; // a sin(w t) + b cos(w t)
  const Real b = force == 0.0 ? 0 : -force * out / square;
  const Real x0 = s.displacement - b, v0 = s.velocity - a * w;
  const Real half = c / (2 * m), discriminant = half * half - k / m;
  Real x, v;
  if (discriminant < 0) {
    const Real wd = std::sqrt(-discriminant), e = std::exp(-half * t), cosine = std::cos(wd * t),
               sine = std::sin(wd * t);
    const Real second = (v0 + half * x0) / wd;
    x = e * (x0 * cosine + second * sine);
    v = -half * x + e * wd * (-x0 * sine + second * cosine);
  } else {
    const Real root = std::sqrt(discriminant), slow = -half + root, fast = -half - root;
    const Real p = (v0 - fast * x0) / (slow - fast), q = x0 - p;
    x = p * std::exp(slow * t) + q * std::exp(fast * t);
    v = p * slow * std::exp(slow * t) + q * fast * std::exp(fast * t);
  }
  return {static_cast<double>(x + a * std::sin(w * t) + b * std::cos(w * t)),
          static_cast<double>(v + w * (a * std::cos(w * t) - b * std::sin(w * t)))};
}

Scene bare(double mass, double stiffness, double damping) {
  Scene scene;
  scene.structure = Structure{};
  scene.structure->mass = mass;
  scene.structure->stiffness = stiffness;
  scene.structure->damping = damping;
  return scene;
}

void force(Scene& scene, double amplitude, double frequency) {
  scene.excitation.kind = ExcitationKind::harmonic;
  scene.excitation.force = amplitude;
  scene.excitation.frequency = frequency;
}

/// Largest error of displacement over the run, against the largest displacement; and the unclosed part of the balance.
struct Outcome {
  double displacement_error = 0.0;
  double velocity_error = 0.0;
  double unclosed = 0.0;
  double losses = 0.0;
};

template <class Reference> Outcome run(const Scene& scene, double dt, std::int64_t steps, Reference&& reference) {
  const EnclosureMotion motion(scene, dt);
  EnclosureState state = motion.start(0.0);
  Outcome outcome;
  double largest = 0.0, fastest = 0.0, work = 0.0, loss = 0.0, first = 0.0, biggest = 0.0;
  for (std::int64_t n = 0; n <= steps; ++n) {
    const EnclosureStep step = motion.advance(state, n, 0.0);
    const Exact exact = reference(static_cast<double>(n) * dt);
    largest = std::max(largest, std::abs(exact.displacement));
    fastest = std::max(fastest, std::abs(exact.velocity));
    outcome.displacement_error = std::max(outcome.displacement_error, std::abs(step.displacement - exact.displacement));
    outcome.velocity_error = std::max(outcome.velocity_error, std::abs(step.velocity - exact.velocity));
    if (n == 0) {
      first = step.stored;
      work = -step.work_in_first_half;
      loss = -step.damping_loss_first_half;
    }
    const double work_here = work + step.work_in_first_half, loss_here = loss + step.damping_loss_first_half;
    biggest = std::max({biggest, std::abs(work_here), first});
    outcome.unclosed = std::max(outcome.unclosed, std::abs(step.stored + loss_here - first - work_here));
    outcome.losses = loss_here;
    work += step.work_in;
    loss += step.damping_loss;
  }
  outcome.displacement_error /= largest;
  outcome.velocity_error /= fastest;
  if (biggest > 0.0) outcome.unclosed /= biggest;
  return outcome;
}

Outcome run(const Scene& scene, double dt, std::int64_t steps) {
  return run(scene, dt, steps, [&](double t) {
    return closed_form(*scene.structure, scene.excitation.force.value_or(0.0), scene.excitation.frequency, t);
  });
}

void check(const Outcome& outcome) {
  MESSAGE("x " << outcome.displacement_error << ", v " << outcome.velocity_error << ", balance " << outcome.unclosed);
  CHECK(outcome.displacement_error < 1e-9);
  CHECK(outcome.velocity_error < 1e-9);
  CHECK(outcome.unclosed < 1e-9);
}

} // namespace

TEST_CASE("a forced structure at resonance over 7 s at a granule's step") {
  Scene scene = bare(0.1, 1000.0, 0.2);
  force(scene, 0.5, 15.91);
  check(run(scene, 6.2e-6, 1129032));
}

TEST_CASE("free decay from a displacement and a velocity") {
  Scene scene = bare(0.5, 800.0, 1.3);
  scene.structure->displacement = 0.01;
  scene.structure->velocity = -0.4;
  const Outcome outcome = run(scene, 1.0e-4, 20000);
  check(outcome);
  CHECK(outcome.losses > 0.0);
}

TEST_CASE("overdamped and forced off resonance") {
  Scene scene = bare(0.2, 50.0, 40.0);
  scene.structure->displacement = 0.02;
  scene.structure->velocity = 3.0;
  force(scene, 7.0, 31.0);
  check(run(scene, 2.0e-4, 10000));
}

TEST_CASE("a 10 kHz structure at few steps per period") {
  Scene scene = bare(0.01, 0.01 * std::pow(2.0 * pi * 1.0e4, 2), 2.0);
  scene.structure->displacement = 1.0e-6;
  force(scene, 10.0, 9.0e3);
  check(run(scene, 1.3e-5, 100000));
}

TEST_CASE("resonance without damping grows as the closed form says") {
  Scene scene = bare(0.1, 1000.0, 0.0);
  const double natural = std::sqrt(1000.0 / 0.1) / (2.0 * pi);
  force(scene, 0.5, natural);
  const double w = 2.0 * pi * natural;
  // x = F0 / (2 M w^2) (sin w t - w t cos w t)
  check(run(scene, 1.0e-4, 70000, [&](double t) {
    const double a = 0.5 / (2.0 * 0.1 * w * w);
    return Exact{a * (std::sin(w * t) - w * t * std::cos(w * t)), a * w * w * t * std::sin(w * t)};
  }));
}

TEST_CASE("a free mass without spring and damper") {
  Scene scene = bare(2.0, 0.0, 0.0);
  scene.structure->velocity = 0.7;
  scene.structure->displacement = -0.1;
  check(run(scene, 1.0e-3, 5000, [](double t) { return Exact{-0.1 + 0.7 * t, 0.7}; }));
  force(scene, 3.0, 5.0);
  const double w = 2.0 * pi * 5.0;
  check(run(scene, 1.0e-3, 5000, [&](double t) {
    return Exact{-0.1 + 0.7 * t + 1.5 / w * (t - std::sin(w * t) / w), 0.7 + 1.5 / w * (1.0 - std::cos(w * t))};
  }));
}

TEST_CASE("a constant reaction moves a free mass by a parabola and a spring to its new rest") {
  Scene scene = bare(2.0, 0.0, 0.0);
  const EnclosureMotion free(scene, 0.01);
  EnclosureState state = free.start(4.0);
  EnclosureStep step;
  for (int n = 0; n <= 100; ++n) step = free.advance(state, n, 4.0);
  CHECK(step.displacement == doctest::Approx(1.0).epsilon(1e-12)); // R t^2 / 2 M
  CHECK(step.velocity == doctest::Approx(2.0).epsilon(1e-12));

  const EnclosureMotion sprung(bare(2.0, 100.0, 50.0), 0.01);
  state = sprung.start(4.0);
  for (int n = 0; n <= 2000; ++n) step = sprung.advance(state, n, 4.0);
  CHECK(step.displacement == doctest::Approx(0.04).epsilon(1e-10));
}

TEST_CASE("each step's halves add up - the velocity increment is the impulse of all forces") {
  Scene scene = bare(0.3, 0.0, 0.0);
  const EnclosureMotion motion(scene, 1.0e-5);
  EnclosureState state = motion.start(0.0);
  double impulse = 0.0;
  for (int n = 0; n < 1000; ++n) {
    const double reaction = std::sin(0.1 * n);
    const EnclosureStep step = motion.advance(state, n, reaction);
    impulse += reaction * 1.0e-5;
    CHECK(step.velocity_after - step.velocity_before == doctest::Approx(reaction * 1.0e-5 / 0.3).epsilon(1e-6));
  }
  CHECK(state.velocity * 0.3 == doctest::Approx(impulse).epsilon(1e-12));
}

TEST_CASE(
    "prescribed motion: displacements add up from the half-step velocities, and the work is against the reaction") {
  Scene scene;
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.amplitude = 0.003;
  scene.excitation.frequency = 40.0;
  scene.excitation.direction = {0.0, 1.0, 0.0};
  const double dt = 1.0e-5;
  const EnclosureMotion motion(scene, dt);
  CHECK(motion.moves());
  CHECK(motion.direction()[1] == 1.0);
  CHECK(motion.initial_velocity() == doctest::Approx(0.003 * 80.0 * pi).epsilon(1e-14));
  EnclosureState state = motion.start(0.0);
  double displacement = 0.0, worst = 0.0;
  for (int n = 0; n < 100000; ++n) {
    const EnclosureStep step = motion.advance(state, n, 2.0);
    worst = std::max(worst, std::abs(step.displacement - displacement));
    CHECK(step.work_in == doctest::Approx(-(step.velocity_before + step.velocity_after) * dt));
    displacement += dt * step.velocity_after;
  }
  CHECK(worst < 1e-14);

  scene.excitation.velocity = -2.5;
  const EnclosureMotion steady(scene, dt);
  state = steady.start(0.0);
  const EnclosureStep step = steady.advance(state, 1000, 0.0);
  CHECK(step.velocity_before == -2.5);
  CHECK(step.velocity_after == -2.5);
  CHECK(step.displacement == doctest::Approx(-0.025));
}

TEST_CASE("the phase keeps its digits after many cycles") {
  Scene scene;
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.amplitude = 1.0;
  scene.excitation.frequency = 1.0;
  const EnclosureMotion motion(scene, 0.125); // eight steps a cycle, exactly
  EnclosureState state;
  CHECK(motion.advance(state, std::int64_t{8} * 1'000'000'000 + 1, 0.0).displacement ==
        doctest::Approx(std::sqrt(0.5)).epsilon(1e-14));
}

TEST_CASE("still without a structure or a prescribed motion") {
  const EnclosureMotion motion(Scene{}, 1.0e-5);
  CHECK_FALSE(motion.moves());
  EnclosureState state = motion.start(3.0);
  const EnclosureStep step = motion.advance(state, 5, 3.0);
  CHECK(step.velocity_after == 0.0);
  CHECK(step.displacement == 0.0);
  CHECK(step.work_in == 0.0);
}
