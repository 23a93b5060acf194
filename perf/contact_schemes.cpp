// An experiment, not a part of the solver: what could make a contact more exact at the same step? A plain scalar damper
// (a box on a structure, Hertz, Tsuji, Coulomb, rotation) with three ways to take a step.
//   fifth: leapfrog, force at t_n from the overlap at t_n and the velocities of t_(n-1/2); friction may take a fifth
//   of what would stop the slip in a step.
//   averaged: the same, but the normal force averaged over the step along the path that the contact's own force
//   predicts.
//   shared: leapfrog; friction may take 1/(1 + n), n the contacts of the busier granule a step ago, but at most half:
//   the solver's.
// Prints the error of single contacts, what a ledger of them leaves over, the energy of an elastic gas, and a damper's
// observables over seeds.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

namespace {

using Vector = std::array<double, 3>;
Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator*(double s, const Vector& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

enum class Scheme { fifth, averaged, shared };
constexpr const char* names[] = {"fifth", "averaged", "shared"};

struct Law {
  double stiffness, alpha, friction; ///< k_n (N/m^1.5), Tsuji's alpha, mu
};

double root25(double d) {
  return d > 0.0 ? d * d * std::sqrt(d) : 0.0;
}
double root125(double d) {
  return d > 0.0 ? d * std::sqrt(std::sqrt(d)) : 0.0;
}

/// Normal force along the line of centres, N; `overlap` (m, negative: apart) and its rate at t_(n-1/2).
double normal_force(Scheme scheme, double overlap, double rate, double mass, const Law& law, double step) {
  const double damping = law.alpha * std::sqrt(mass * law.stiffness);
  if (scheme != Scheme::averaged) {
    if (overlap <= 0.0) return 0.0;
    return law.stiffness * overlap * std::sqrt(overlap) + damping * std::sqrt(std::sqrt(overlap)) * rate;
  }
  // Rate at t_n as the contact's own force predicts it, then the mean of the force from half a step before to half a
  // step after: of k d^1.5 exactly for a steady rate, of the damping as what it takes between the two overlaps.
  double middle = rate;
  if (overlap > 0.0) {
    const double first = law.stiffness * overlap * std::sqrt(overlap) + damping * std::sqrt(std::sqrt(overlap)) * rate;
    middle -= 0.5 * step * first / mass;
  }
  const double before = overlap - 0.5 * step * middle, after = overlap + 0.5 * step * middle;
  if (before <= 0.0 && after <= 0.0) return 0.0;
  const double way = middle * step;
  const double spring = std::abs(way) > 1e-9 * std::abs(overlap)
                            ? 0.4 * law.stiffness * (root25(after) - root25(before)) / way
                            : law.stiffness * overlap * std::sqrt(std::max(overlap, 0.0));
  return spring + 0.8 * damping * (root125(after) - root125(before)) / step;
}

struct Grain {
  Vector x{}, v{}, w{}, force{}, torque{};
  int contacts = 0, contacts_before = 0;
};

struct Damper {
  double radius = 3.2e-3, mass = 0.0;
  Law pair{}, wall{};
  Vector size{0.025, 0.025, 0.0359};
  double gravity = 9.81;
  double host_mass = 0.1, host_stiffness = 1000.0, host_damping = 0.2, force = 0.5, frequency = 15.91;
  bool held = false; ///< the box stands still
  std::vector<Grain> grains;
  double x = 0.0, v = 0.0, time = 0.0, dissipated = 0.0, reaction = 0.0;

  double reach(Scheme scheme, double rate, double step) const {
    return scheme == Scheme::averaged ? 0.5 * step * std::abs(rate) : 0.0;
  }

  /// Both granules, or one and the wall (other = null), which moves at `wall_velocity`.
  void touch(Scheme scheme, Grain& one, Grain* other, const Vector& normal, double overlap, const Vector& wall_velocity,
             double step) {
    const Law& law = other ? pair : wall;
    const double m = other ? 0.5 * mass : mass;
    const Vector relative = one.v - (other ? other->v : wall_velocity);
    const double rate = dot(relative, normal);
    if (overlap <= 0.0 && overlap + 0.5 * step * std::abs(rate) <= 0.0) return;
    if (overlap <= 0.0 && scheme != Scheme::averaged) return;
    const double f = normal_force(scheme, overlap, rate, m, law, step);
    if (f == 0.0) return;
    ++one.contacts;
    if (other) ++other->contacts;
    const double arm = radius - (other ? 0.5 : 1.0) * std::max(overlap, 0.0);
    const Vector rolling = arm * (other ? one.w + other->w : one.w);
    const Vector slip = relative - rate * normal + cross(rolling, normal);
    const double speed = std::sqrt(dot(slip, slip));
    Vector friction{};
    if (speed > 0.0 && law.friction > 0.0) {
      double share = 0.2;
      if (scheme == Scheme::shared)
        share = 1.0 / (1 + std::max({1, one.contacts_before, other ? other->contacts_before : 0}));
      const double bound = share * 2.0 / 7.0 * m * speed / step;
      friction = (-std::min(law.friction * std::abs(f), bound) / speed) * slip;
    }
    const Vector all = friction - f * normal;
    one.force = one.force + all;
    one.torque = one.torque + arm * cross(normal, friction);
    if (other) {
      other->force = other->force - all;
      other->torque = other->torque + arm * cross(normal, friction);
    } else {
      reaction -= all[2];
    }
  }

  void step(Scheme scheme, double dt) {
    reaction = 0.0;
    for (Grain& one : grains) {
      one.contacts_before = one.contacts;
      one.contacts = 0;
      one.force = {0.0, 0.0, -gravity * mass};
      one.torque = {};
    }
    const double far = 2.0 * radius + 4.0 * dt;
    for (std::size_t i = 0; i < grains.size(); ++i) {
      for (std::size_t j = i + 1; j < grains.size(); ++j) {
        const Vector line = grains[j].x - grains[i].x;
        const double square = dot(line, line);
        if (square > far * far) continue;
        const double distance = std::sqrt(square);
        touch(scheme, grains[i], &grains[j], (1.0 / distance) * line, 2.0 * radius - distance, {}, dt);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double at = grains[i].x[k] - (k == 2 ? x : 0.0);
        Vector normal{};
        normal[k] = -1.0;
        touch(scheme, grains[i], nullptr, normal, radius - at, {0.0, 0.0, v}, dt);
        normal[k] = 1.0;
        touch(scheme, grains[i], nullptr, normal, radius - (size[k] - at), {0.0, 0.0, v}, dt);
      }
    }
    for (Grain& one : grains) {
      one.v = one.v + (dt / mass) * one.force;
      one.w = one.w + (dt / (0.4 * mass * radius * radius)) * one.torque;
      one.x = one.x + dt * one.v;
    }
    if (!held) {
      const double pull = force * std::sin(2.0 * std::numbers::pi * frequency * time) + reaction - host_stiffness * x;
      v = ((host_mass - 0.5 * dt * host_damping) * v + dt * pull) / (host_mass + 0.5 * dt * host_damping);
      x += dt * v;
    }
    time += dt;
  }

  /// Kinetic and elastic; velocities are half a step old, which an average over many granules does not show.
  double energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < grains.size(); ++i) {
      const Grain& one = grains[i];
      sum += 0.5 * mass * dot(one.v, one.v) + 0.2 * mass * radius * radius * dot(one.w, one.w);
      for (std::size_t j = i + 1; j < grains.size(); ++j) {
        const Vector line = grains[j].x - one.x;
        sum += 0.4 * pair.stiffness * root25(2.0 * radius - std::sqrt(dot(line, line)));
      }
      for (std::size_t k = 0; k < 3; ++k)
        sum += 0.4 * wall.stiffness * (root25(radius - one.x[k]) + root25(radius - size[k] + one.x[k]));
    }
    return sum;
  }
};

std::uint64_t state = 1;
double random_number() {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

double alpha_of(double e) {
  const double l = std::log(e);
  return -std::sqrt(5.0) * l / std::hypot(l, std::numbers::pi);
}

Damper damper_of(double radius, double restitution, double friction) {
  Damper d;
  d.radius = radius;
  d.mass = 1190.0 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  d.pair = {1.0e7 * std::sqrt(radius / 3.0e-3), alpha_of(restitution), friction};
  d.wall = {1.3e7 * std::sqrt(radius / 3.0e-3), alpha_of(restitution), friction};
  return d;
}

/// Of unit mass, stiffness and speed.
constexpr double contact_time_of_one = 3.2180;

double contact_duration(const Damper& d, double speed) {
  const double m = 0.5 * d.mass;
  return contact_time_of_one * std::pow(m * m / (d.pair.stiffness * d.pair.stiffness * speed), 0.2);
}

void fill(Damper& d, int count, double speed) {
  const double pitch = 2.02 * d.radius;
  const auto nx = static_cast<int>(d.size[0] / pitch), nz = static_cast<int>(d.size[2] / pitch);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < nx; ++j)
      for (int i = 0; i < nx; ++i) {
        if (static_cast<int>(d.grains.size()) == count) return;
        Grain one;
        const double room = (d.size[0] - nx * pitch) / nx;
        one.x = {(i + 0.5) * (pitch + room), (j + 0.5) * (pitch + room), (k + 0.5) * pitch};
        for (double& c : one.v) c = speed * (2.0 * random_number() - 1.0);
        d.grains.push_back(one);
      }
}

/// Two granules; the deviation of what they leave with, over the speed, root mean square over phases.
double contact_error(Scheme scheme, double steps, double along, double friction, double& mean, double& deviation) {
  const auto leave = [&](double k, double phase) {
    Damper d = damper_of(1.85e-3, 0.8974, friction);
    d.gravity = 0.0;
    d.held = true;
    d.size = {1.0, 1.0, 1.0};
    const double speed = 5.0, dt = contact_duration(d, speed) / k, cosine = std::sqrt(1.0 - along * along);
    d.grains.resize(2);
    for (int g = 0; g < 2; ++g) {
      const double sign = g == 0 ? 1.0 : -1.0;
      d.grains[g].v = {sign * 0.5 * speed * cosine, sign * 0.5 * speed * along, 0.0};
      d.grains[g].x = Vector{0.5 - sign * d.radius, 0.5, 0.5} - (phase * dt) * d.grains[g].v;
    }
    for (int n = 0; n < static_cast<int>(3.0 * k); ++n) d.step(scheme, dt);
    return d.grains[0];
  };
  const Grain right = leave(4000.0, 0.5);
  constexpr int phases = 64;
  double sum = 0.0, squares = 0.0;
  mean = 0.0;
  for (int p = 0; p < phases; ++p) {
    const Grain met = leave(steps, 1.0 + (p + 0.5) / phases);
    const Vector v = met.v - right.v, w = 1.85e-3 * (met.w - right.w);
    sum += (dot(v, v) + 0.4 * dot(w, w)) / (2.5 * 2.5) / phases;
    const double e = -met.v[0] / 2.5;
    mean += e / phases;
    squares += e * e / phases;
  }
  deviation = std::sqrt(std::max(0.0, squares - mean * mean));
  return std::sqrt(sum);
}

void single_contacts() {
  std::printf("single contacts, e = 0.8974\nscheme, steps, frictionless head on: error, mean e, deviation; mu = 0.52 "
              "at 45 degrees: error\n");
  for (const Scheme scheme : {Scheme::fifth, Scheme::averaged, Scheme::shared})
    for (const double steps : {4.0, 6.0, 8.0, 12.0, 16.0, 32.0}) {
      double mean = 0.0, deviation = 0.0, other = 0.0, unused = 0.0;
      const double straight = contact_error(scheme, steps, 0.0, 0.0, mean, deviation);
      const double oblique = contact_error(scheme, steps, std::sqrt(0.5), 0.52, other, unused);
      std::printf("%-9s %3g  %.5f %.5f %.5f  %.5f\n", names[static_cast<int>(scheme)], steps, straight, mean, deviation,
                  oblique);
    }
}

/// One granule of unit mass head on against a wall of unit stiffness at unit speed: its energy before, less that after,
/// less what damping took by the sum of c v^2 dt, with v at t_n taken in three ways; over its loss, in the mean over
/// phases of entry.
std::array<double, 3> left_over(double alpha, double steps, bool verlet, double& restitution) {
  const double dt = contact_time_of_one / steps;
  std::array<double, 3> sums{};
  double losses = 0.0;
  restitution = 0.0;
  constexpr int phases = 64;
  for (int p = 0; p < phases; ++p) {
    double x = -(p + 0.5) / phases * dt, v = 1.0, kick = 0.0, kick_before = 0.0, damping_before = 0.0,
           mean_before = 1.0;
    std::array<double, 3> taken{};
    for (int n = 0; n < 3 || x > 0.0 || kick != 0.0; ++n) {
      const double overlap = std::max(x, 0.0), seen = verlet ? v + 0.5 * kick : v;
      const double damping = alpha * std::sqrt(std::sqrt(overlap)) * seen;
      const double now = -(overlap * std::sqrt(overlap) + damping) * dt, mean = v + 0.5 * now;
      taken[0] += damping * mean * dt;
      taken[1] += damping * (mean - (now - kick) / 6.0) * dt;
      taken[2] += damping_before * (mean_before - (now - kick_before) / 12.0) * dt; // of the step before
      kick_before = kick;
      kick = now;
      damping_before = damping;
      mean_before = mean;
      v += now;
      x += v * dt;
    }
    const double loss = 0.5 * (1.0 - v * v);
    losses += loss / phases;
    restitution -= v / phases;
    for (std::size_t k = 0; k < 3; ++k) sums[k] += (loss - taken[k]) / phases;
  }
  for (double& sum : sums) sum /= losses;
  return sums;
}

void ledgers() {
  std::printf(
      "what the ledger of one contact leaves over, of its loss: integrator, steps, e; velocity the mean of two half "
      "steps, with a one-sided difference, with a central one\n");
  for (const bool verlet : {false, true})
    for (const double alpha : {0.05, 0.2, 0.5, 1.2})
      for (const double steps : {6.0, 8.0, 16.0}) {
        double restitution = 0.0;
        const std::array<double, 3> left = left_over(alpha, steps, verlet, restitution);
        std::printf("%-9s %3g  %.3f  %+.4f %+.4f %+.4f\n", verlet ? "verlet" : "leapfrog", steps, restitution, left[0],
                    left[1], left[2]);
      }
}

void elastic_gas() {
  std::printf("elastic frictionless gas, 64 granules at up to 2.5 m/s per axis, 20 ms: energy at the end over that at "
              "the start, less 1\n");
  for (const Scheme scheme : {Scheme::fifth, Scheme::averaged})
    for (const double steps : {4.0, 6.0, 8.0, 16.0}) {
      double mean = 0.0, squares = 0.0;
      constexpr int seeds = 6;
      for (int s = 0; s < seeds; ++s) {
        state = static_cast<std::uint64_t>(s) * 7919 + 1;
        Damper d = damper_of(2.0e-3, 1.0, 0.0);
        d.gravity = 0.0;
        d.held = true;
        fill(d, 64, 2.5);
        const double dt = contact_duration(d, 5.0) / steps, start = d.energy();
        while (d.time < 0.02) d.step(scheme, dt);
        const double change = d.energy() / start - 1.0;
        mean += change / seeds;
        squares += change * change / seeds;
      }
      std::printf("%-9s %3g  %+.4f +- %.4f\n", names[static_cast<int>(scheme)], steps, mean,
                  std::sqrt(std::max(0.0, squares - mean * mean) / seeds));
    }
}

void damper_observables(int seeds, double duration) {
  std::printf(
      "damper, 61 granules of 3.2 mm, %d seeds of %g s: rms (mm), work put in per second (mJ/s), contacts per granule, "
      "processor s per simulated s\n",
      seeds, duration);
  for (const double steps : {64.0, 4.0, 6.0, 8.0, 16.0})
    for (const Scheme scheme : {Scheme::fifth, Scheme::averaged, Scheme::shared}) {
      if (steps == 64.0 && scheme != Scheme::fifth) continue;
      std::array<double, 3> mean{}, squares{};
      double seconds = 0.0;
      for (int s = 0; s < seeds; ++s) {
        state = static_cast<std::uint64_t>(s) * 104729 + 17;
        Damper d = damper_of(3.2e-3, 0.89, 0.52);
        fill(d, 61, 0.05);
        const double dt = contact_duration(d, 5.0) / steps;
        const std::clock_t start = std::clock();
        double sum = 0.0, work = 0.0, contacts = 0.0;
        std::int64_t n = 0;
        const double from = 0.25 * duration;
        while (d.time < duration) {
          const double drive = d.force * std::sin(2.0 * std::numbers::pi * d.frequency * d.time);
          d.step(scheme, dt);
          if (d.time < from) continue;
          sum += d.x * d.x;
          work += drive * d.v * dt;
          for (const Grain& one : d.grains) contacts += one.contacts;
          ++n;
        }
        seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / duration / seeds;
        const std::array<double, 3> values{1e3 * std::sqrt(sum / static_cast<double>(n)),
                                           1e3 * work / (duration - from), contacts / static_cast<double>(n) / 61.0};
        for (std::size_t k = 0; k < 3; ++k) {
          mean[k] += values[k] / seeds;
          squares[k] += values[k] * values[k] / seeds;
        }
      }
      std::printf("%-9s %3g ", names[static_cast<int>(scheme)], steps);
      for (std::size_t k = 0; k < 3; ++k)
        std::printf(" %8.4f +- %.4f", mean[k],
                    std::sqrt(std::max(0.0, squares[k] - mean[k] * mean[k]) / std::max(1, seeds - 1)));
      std::printf("  %.3f\n", seconds);
      std::fflush(stdout);
    }
}

} // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 8;
  const double duration = argc > 2 ? std::atof(argv[2]) : 2.0;
  single_contacts();
  ledgers();
  elastic_gas();
  if (seeds > 0) damper_observables(seeds, duration);
}
