// Excitations other than a sine: the bare structure against closed forms and an independent integration, its energies,
// and what the signals are.
#include "solver/enclosure_motion.hpp"
#include "solver/excitation_signal.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <doctest/doctest.h>
#include <functional>
#include <numbers>
#include <vector>

using namespace grandamp;

namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;
using ByTime = std::function<double(double)>;

Scene structure_of(double mass, double frequency, double ratio, ExcitationKind kind, double duration) {
  Scene scene;
  const double w = 2.0 * pi * frequency;
  scene.structure = Structure{};
  scene.structure->mass = mass;
  scene.structure->stiffness = mass * w * w;
  scene.structure->damping = 2.0 * ratio * mass * w;
  scene.excitation.kind = kind;
  scene.time.duration = duration;
  return scene;
}

/// x, x' by Runge-Kutta steps of M x'' + c (x' - y') + K (x - y) = F; starts and ends between jumps of F.
struct Scalar {
  double x = 0.0, v = 0.0, t = 0.0;
  void go(const Structure& s, double until, const ByTime& force, const ByTime& y, const ByTime& rate, double longest) {
    const int steps = static_cast<int>(std::ceil((until - t) / longest));
    const double h = (until - t) / steps, from = t;
    const auto a = [&](double time, double x1, double v1) {
      return (force(time) - s.damping * (v1 - rate(time)) - s.stiffness * (x1 - y(time))) / s.mass;
    };
    for (int n = 0; n < steps; ++n) {
      const double begin = from + n * h;
      const double a1 = a(begin, x, v), v2 = v + 0.5 * h * a1, a2 = a(begin + 0.5 * h, x + 0.5 * h * v, v2);
      const double v3 = v + 0.5 * h * a2, a3 = a(begin + 0.5 * h, x + 0.5 * h * v2, v3);
      const double v4 = v + h * a3, a4 = a(begin + h, x + h * v3, v4);
      x += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
      v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    t = until;
  }
};

ByTime zero() {
  return [](double) { return 0.0; };
}

struct Outcome {
  double displacement = 0.0, velocity = 0.0; ///< largest errors, over the largest values
  double unclosed = 0.0;                     ///< of the balance, over the largest of its terms
  double work = 0.0;
};

/// The scene's motion by steps of dt; `exact` tells (x, v) at the times that it is asked for, in order.
Outcome run(const Scene& scene, double dt, const std::function<std::pair<double, double>(double)>& exact) {
  const EnclosureMotion motion(scene, dt);
  EnclosureState state = motion.start(0.0);
  Outcome outcome;
  double largest = 0.0, fastest = 0.0, work = 0.0, loss = 0.0, first = 0.0, biggest = 0.0;
  const auto steps = static_cast<std::int64_t>(std::llround(scene.time.duration / dt));
  for (std::int64_t n = 0; n <= steps; ++n) {
    const EnclosureStep step = motion.advance(state, n, 0.0);
    const auto [x, v] = exact(static_cast<double>(n) * dt);
    largest = std::max(largest, std::abs(x));
    fastest = std::max(fastest, std::abs(v));
    outcome.displacement = std::max(outcome.displacement, std::abs(step.displacement - x));
    outcome.velocity = std::max(outcome.velocity, std::abs(step.velocity - v));
    if (n == 0) {
      first = step.stored;
      work = -step.work_in_first_half;
      loss = -step.damping_loss_first_half;
    }
    const double work_here = work + step.work_in_first_half, loss_here = loss + step.damping_loss_first_half;
    biggest = std::max({biggest, std::abs(work_here), loss_here, step.stored});
    outcome.unclosed = std::max(outcome.unclosed, std::abs(step.stored + loss_here - first - work_here));
    outcome.work = work_here;
    work += step.work_in;
    loss += step.damping_loss;
  }
  outcome.displacement /= largest;
  outcome.velocity /= fastest;
  outcome.unclosed /= biggest;
  return outcome;
}

void check(const Outcome& outcome, double tolerance = 1.0e-6) {
  MESSAGE("x " << outcome.displacement << ", v " << outcome.velocity << ", balance " << outcome.unclosed);
  CHECK(outcome.displacement < tolerance);
  CHECK(outcome.velocity < tolerance);
  CHECK(outcome.unclosed < 1.0e-9);
  CHECK(outcome.work > 0.0);
}

/// Free vibration and the forced part Im(forced e^(iwt)), from (x0, v0).
std::pair<double, double> damped(const Structure& s, Complex forced, double w, double x0, double v0, double t) {
  const Complex under = std::sqrt(Complex(s.damping * s.damping - 4.0 * s.mass * s.stiffness));
  const Complex a = (-s.damping + under) / (2.0 * s.mass), b = (-s.damping - under) / (2.0 * s.mass);
  const double rest = x0 - forced.imag(), rest_velocity = v0 - (Complex(0.0, w) * forced).imag();
  const Complex part_a = (rest_velocity - b * rest) / (a - b), part_b = rest - part_a;
  const Complex turn = std::exp(Complex(0.0, w * t));
  return {(part_a * std::exp(a * t) + part_b * std::exp(b * t)).real() + (forced * turn).imag(),
          (part_a * a * std::exp(a * t) + part_b * b * std::exp(b * t)).real() +
              (Complex(0.0, w) * forced * turn).imag()};
}

} // namespace

TEST_CASE("base excitation: the transmissibility and the transient of the closed form, at any step") {
  for (const double frequency : {5.0, 15.9, 60.0}) {
    Scene scene = structure_of(0.1, 15.915, 0.03, ExcitationKind::base, 2.0);
    Structure& s = *scene.structure;
    s.displacement = 2.0e-4;
    s.velocity = -0.01;
    scene.excitation.frequency = frequency;
    scene.excitation.amplitude = 1.0e-3;
    const double w = 2.0 * pi * frequency;
    const Complex forced =
        1.0e-3 * Complex(s.stiffness, s.damping * w) / Complex(s.stiffness - s.mass * w * w, s.damping * w);
    for (const double dt : {1.0e-5, 1.0e-3, 0.01})
      check(run(scene, dt, [&](double t) { return damped(s, forced, w, 2.0e-4, -0.01, t); }), 1.0e-9);
    scene.excitation.amplitude = 0.0;
    scene.excitation.acceleration = 1.0e-3 * w * w;
    check(run(scene, 1.0e-3, [&](double t) { return damped(s, forced, w, 2.0e-4, -0.01, t); }), 1.0e-9);
  }
}

TEST_CASE("an impulse against Duhamel's closed form, wherever it falls between the steps") {
  for (const double pulse : {1.0e-4, 3.3e-3, 0.04}) {
    Scene scene = structure_of(0.5, 20.0, 0.02, ExcitationKind::impulse, 0.5);
    scene.excitation.force = 40.0;
    scene.excitation.start = 0.01234567;
    scene.excitation.pulse_duration = pulse;
    const Structure& s = *scene.structure;
    const double w = pi / pulse, begin = scene.excitation.start;
    const Complex forced = 40.0 / Complex(s.stiffness - s.mass * w * w, s.damping * w);
    const auto exact = [&](double t) -> std::pair<double, double> {
      if (t <= begin) return {0.0, 0.0};
      if (t <= begin + pulse) return damped(s, forced, w, 0.0, 0.0, t - begin);
      const auto [x, v] = damped(s, forced, w, 0.0, 0.0, pulse);
      return damped(s, 0.0, 0.0, x, v, t - begin - pulse);
    };
    for (const double dt : {1.0e-5, 5.0e-4, 2.5e-3}) {
      CAPTURE(pulse);
      CAPTURE(dt);
      check(run(scene, dt, exact));
    }
  }
}

TEST_CASE("a free mass takes the impulse 2 F d / pi") {
  Scene scene;
  scene.structure = Structure{};
  scene.structure->mass = 2.0;
  scene.excitation.kind = ExcitationKind::impulse;
  scene.excitation.force = 7.0;
  scene.excitation.start = 0.1003;
  scene.excitation.pulse_duration = 2.7e-3;
  const EnclosureMotion motion(scene, 1.0e-3);
  EnclosureState state = motion.start(0.0);
  for (int n = 0; n <= 200; ++n) motion.advance(state, n, 0.0);
  CHECK(2.0 * state.velocity == doctest::Approx(2.0 * 7.0 * 2.7e-3 / pi).epsilon(1.0e-9));
}

TEST_CASE("chirps against a fine integration, up and down, linear and logarithmic, and what follows their end") {
  for (const Sweep sweep : {Sweep::linear, Sweep::logarithmic})
    for (const bool down : {false, true}) {
      Scene scene = structure_of(0.1, 15.915, 0.01, ExcitationKind::chirp, 4.0);
      scene.excitation.force = 0.5;
      scene.excitation.start_frequency = down ? 30.0 : 8.0;
      scene.excitation.end_frequency = down ? 8.0 : 30.0;
      scene.excitation.sweep = sweep;
      scene.excitation.sweep_duration = 3.01037;
      const double f = scene.excitation.start_frequency, g = scene.excitation.end_frequency, end = 3.01037;
      const ByTime force = [&](double t) {
        const double cycles = sweep == Sweep::linear ? f * t + 0.5 * (g - f) / end * t * t
                                                     : f * end / std::log(g / f) * (std::pow(g / f, t / end) - 1.0);
        return 0.5 * std::sin(2.0 * pi * cycles);
      };
      for (const double dt : {2.0e-5, 1.0e-3, 8.0e-3}) {
        Scalar scalar;
        check(run(scene, dt, [&](double t) {
          const auto go = [&](double until, const ByTime& pushed) {
            if (until > scalar.t) scalar.go(*scene.structure, until, pushed, zero(), zero(), 1.0e-4);
          };
          go(std::min(t, end), force);
          go(t, zero());
          return std::pair(scalar.x, scalar.v);
        }));
      }
    }
}

TEST_CASE("random forces: the response is that of a fine integration of the signal") {
  Scene scene = structure_of(0.1, 15.915, 0.01, ExcitationKind::random, 6.0);
  scene.excitation.force_rms = 0.3;
  scene.excitation.band = {5.0, 40.0};
  scene.seed = 5;
  const auto signal = make_force_signal(scene);
  for (const double dt : {5.0e-5, 1.0e-3, 5.0e-3}) {
    Scalar scalar;
    check(run(scene, dt, [&](double t) {
      if (t > scalar.t)
        scalar.go(
            *scene.structure, t,
            [&](double at) {
              return signal->at({at, 0.0});
            },
            zero(), zero(), 1.0e-4);
      return std::pair(scalar.x, scalar.v);
    }));
  }
}

TEST_CASE("random forces have their rms, a flat spectrum inside the band and nothing outside") {
  Scene scene = structure_of(0.1, 15.915, 0.01, ExcitationKind::random, 1.0);
  scene.excitation.force_rms = 2.0;
  scene.excitation.band = {20.0, 60.0};
  const auto signal = make_force_signal(scene);
  // Many stretches of 0.8 s under a window, 1.25 Hz apart in frequency: the mean over stretches of their powers.
  constexpr int stretches = 1500, samples = 256;
  constexpr double length = 0.8;
  std::vector<double> power(80, 0.0);
  double square = 0.0;
  for (int s = 0; s < stretches; ++s) {
    std::vector<double> force(samples);
    for (int k = 0; k < samples; ++k) {
      force[static_cast<std::size_t>(k)] = signal->at({length * (s + static_cast<double>(k) / samples), 0.0});
      square += force[static_cast<std::size_t>(k)] * force[static_cast<std::size_t>(k)];
    }
    for (std::size_t bin = 0; bin < power.size(); ++bin) {
      Complex sum = 0.0;
      for (int k = 0; k < samples; ++k) {
        const double place = static_cast<double>(k) / samples;
        sum += force[static_cast<std::size_t>(k)] * (1.0 - std::cos(2.0 * pi * place)) *
               std::polar(1.0, -2.0 * pi * static_cast<double>(bin) * place);
      }
      power[bin] += std::norm(sum) / stretches;
    }
  }
  CHECK(std::sqrt(square / (stretches * samples)) == doctest::Approx(2.0).epsilon(0.02));
  // Bins of 1.25 Hz: 20 to 60 Hz are 16 to 48. The window reaches two bins far.
  double mean = 0.0;
  for (std::size_t bin = 19; bin <= 45; ++bin) mean += power[bin] / 27.0;
  for (std::size_t bin = 19; bin <= 45; ++bin) CHECK(power[bin] == doctest::Approx(mean).epsilon(0.15));
  for (std::size_t bin = 0; bin < power.size(); ++bin)
    if (bin < 13 || bin > 51) CHECK(power[bin] < 1.0e-3 * mean);
}

TEST_CASE("a random force is a function of its seeds and of time, asked in any order") {
  Scene scene = structure_of(0.1, 15.915, 0.01, ExcitationKind::random, 1.0);
  scene.excitation.force_rms = 1.0;
  scene.excitation.band = {100.0, 2000.0};
  const auto signal = make_force_signal(scene), again = make_force_signal(scene);
  scene.seed = 2;
  const auto other_scene = make_force_signal(scene);
  scene.seed = 1;
  scene.excitation.seed = 9;
  const auto other_seed = make_force_signal(scene);
  std::vector<double> forwards;
  double apart_scene = 0.0, apart_seed = 0.0, jump = 0.0;
  constexpr int asked = 20000;
  constexpr double spacing = 1.7e-5;
  for (int k = 0; k < asked; ++k) {
    forwards.push_back(signal->at({k * spacing, 0.0}));
    apart_scene += std::pow(other_scene->at({k * spacing, 0.0}) - forwards.back(), 2) / asked;
    apart_seed += std::pow(other_seed->at({k * spacing, 0.0}) - forwards.back(), 2) / asked;
  }
  for (int k = asked - 1; k >= 0; --k) CHECK(again->at({k * spacing, 0.0}) == forwards[static_cast<std::size_t>(k)]);
  CHECK(apart_scene == doctest::Approx(2.0).epsilon(0.2)); // of two signals that have nothing in common
  CHECK(apart_seed == doctest::Approx(2.0).epsilon(0.2));
  // No jumps where one interpolant follows the other, cells of 0.25 ms or a little less.
  for (double t = 0.0; t < 0.3; t += 1.0e-6) {
    const double here = signal->at({t, 0.0}), there = signal->at({t + 1.0e-9, 0.0});
    jump = std::max(jump, std::abs(there - here));
  }
  CHECK(jump < 1.0e-4); // 2 pi 2000 Hz times 4.5 rms times 1 ns, and no more
}

TEST_CASE("a table of a harmonic force is that force, and lines between rows are lines") {
  Scene sine = structure_of(0.1, 15.915, 0.02, ExcitationKind::harmonic, 2.0);
  sine.excitation.force = 0.4;
  sine.excitation.frequency = 12.0;
  Scene table = sine;
  table.excitation = {};
  table.excitation.kind = ExcitationKind::table;
  for (int k = -3; k <= 9000; ++k) {
    const double t = k * 2.5e-4 + (k % 3 == 0 ? 4.0e-5 : 0.0); // no even rows
    table.excitation.times.push_back(t);
    table.excitation.values.push_back(0.4 * std::sin(2.0 * pi * 12.0 * t));
  }
  const Structure& s = *sine.structure;
  const double w = 2.0 * pi * 12.0;
  const Complex forced = 0.4 / Complex(s.stiffness - s.mass * w * w, s.damping * w);
  for (const double dt : {2.0e-5, 1.0e-3, 4.0e-3})
    check(run(table, dt, [&](double t) { return damped(s, forced, w, 0.0, 0.0, t); }));

  Scene ramp = structure_of(0.1, 15.915, 0.02, ExcitationKind::table, 0.6);
  ramp.excitation.times = {0.1, 0.2003, 0.3};
  ramp.excitation.values = {0.5, -1.0, 2.0};
  ramp.excitation.interpolation = Interpolation::linear;
  Scalar scalar;
  check(run(ramp, 1.0e-3, [&](double t) {
    const ByTime up = [](double at) { return 0.5 - 1.5 * (at - 0.1) / 0.1003; };
    const ByTime down = [](double at) { return -1.0 + 3.0 * (at - 0.2003) / 0.0997; };
    const auto go = [&](double until, const ByTime& force) {
      if (until > scalar.t) scalar.go(*ramp.structure, until, force, zero(), zero(), 1.0e-4);
    };
    go(std::min(t, 0.1), zero());
    go(std::min(t, 0.2003), up);
    go(std::min(t, 0.3), down);
    go(t, zero());
    return std::pair(scalar.x, scalar.v);
  }));
}

TEST_CASE("tables of a foundation's displacement or acceleration") {
  const double w = 2.0 * pi * 13.0, reach = 1.0e-3;
  Scene table = structure_of(0.1, 15.915, 0.05, ExcitationKind::table, 1.0);
  const ByTime y = [&](double t) { return reach * (1.0 - std::cos(w * t)); };
  const ByTime rate = [&](double t) { return reach * w * std::sin(w * t); };
  for (const bool displacement : {true, false}) {
    Excitation& e = table.excitation;
    e.quantity = displacement ? TableQuantity::displacement : TableQuantity::acceleration;
    e.times.clear();
    e.values.clear();
    for (int k = -2; k <= 2010; ++k) {
      e.times.push_back(k * 5.0e-4);
      e.values.push_back(displacement ? y(k * 5.0e-4) : reach * w * w * std::cos(w * k * 5.0e-4));
    }
    for (const double dt : {1.0e-5, 1.0e-3, 4.0e-3}) {
      Scalar scalar;
      check(run(table, dt, [&](double t) {
        if (t > scalar.t) scalar.go(*table.structure, t, zero(), y, rate, 1.0e-4);
        return std::pair(scalar.x, scalar.v);
      }));
    }
  }
}

TEST_CASE("a table of the enclosure's own motion: displacements add up from the half-step velocities") {
  Scene scene;
  scene.time.duration = 1.0;
  scene.excitation.kind = ExcitationKind::table;
  scene.excitation.quantity = TableQuantity::displacement;
  scene.excitation.direction = {0.0, 0.6, 0.8};
  for (int k = 0; k <= 4000; ++k) {
    scene.excitation.times.push_back(k * 2.5e-4);
    scene.excitation.values.push_back(0.25 + 0.003 * std::sin(80.0 * k * 2.5e-4));
  }
  const double dt = 3.7e-5;
  const EnclosureMotion motion(scene, dt);
  CHECK(motion.moves());
  CHECK(motion.direction() == Vector3{0.0, 0.6, 0.8});
  EnclosureState state = motion.start(0.0);
  double displacement = 0.25, off = 0.0, worst = 0.0;
  for (int n = 0; n < 27000; ++n) {
    const EnclosureStep step = motion.advance(state, n, 2.0);
    worst = std::max(worst, std::abs(step.displacement - displacement));
    off = std::max({off, std::abs(step.displacement - 0.25 - 0.003 * std::sin(80.0 * n * dt)) / 0.003,
                    std::abs(step.velocity - 0.24 * std::cos(80.0 * n * dt)) / 0.24});
    CHECK(step.work_in == doctest::Approx(-(step.velocity_before + step.velocity_after) * dt));
    displacement += dt * step.velocity_after;
  }
  CHECK(worst < 1.0e-13);
  CHECK(off < 1.0e-6);
}

TEST_CASE("signals keep their digits late in a run") {
  Scene scene = structure_of(0.1, 15.915, 0.01, ExcitationKind::chirp, 1.0e4);
  scene.excitation.force = 1.0;
  scene.excitation.start_frequency = 50.0;
  scene.excitation.end_frequency = 50.0 + 1.0 / 1024.0;
  scene.excitation.sweep_duration = 8192.0;
  const auto signal = make_force_signal(scene);
  // Whole seconds: 50 t + t^2 / 2^24 cycles, exactly. The rest of an instant counts, too.
  for (const double t : {4096.0, 6144.0, 8191.0}) {
    const double cycles = std::fmod(t * t / 16777216.0, 1.0);
    CHECK(signal->at({t, 0.0}) == doctest::Approx(std::sin(2.0 * pi * cycles)).epsilon(1.0e-13));
    const double later = cycles + 1.0e-14 * (50.0 + t / 8388608.0);
    CHECK(signal->at({t, 1.0e-14}) - std::sin(2.0 * pi * later) == doctest::Approx(0.0).epsilon(1.0e-15));
  }
}
