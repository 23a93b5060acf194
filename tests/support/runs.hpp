// The solver and the oracle behind one face, so that a test of physics is put to both: to the solver because it must
// pass, to the oracle because a judge must be judged first.
#pragma once

#include "solver/simulation.hpp"
#include "tests/support/reference_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace grandamp::test {

/// Gives the scene this step and makes its duration (rounded up) a whole number of them.
inline void use_step(Scene& scene, double step) {
  scene.time.step = step;
  scene.time.duration = step * std::ceil(scene.time.duration / step);
}

/// The step that the contract makes of time.step: duration over round(duration / step).
inline double step_of(const Scene& scene) {
  return scene.time.duration / std::round(scene.time.duration / scene.time.step.value());
}

inline std::int64_t steps_of(const Scene& scene) {
  return static_cast<std::int64_t>(std::llround(scene.time.duration / scene.time.step.value()));
}

class SolverRun {
public:
  explicit SolverRun(const Scene& scene) : simulation_(scene, single_thread()) {}
  void step() { simulation_.step(); }
  Sample sample() { return simulation_.sample(); }
  Sample step_and_sample() { return simulation_.step_and_sample(); }
  GranuleTable granules() { return simulation_.granules(); }
  double time_step() const { return simulation_.plan().time_step; }
  Simulation& simulation() { return simulation_; }

private:
  static RunOptions single_thread() {
    RunOptions options;
    options.threads = 1;
    return options;
  }
  Simulation simulation_;
};

class OracleRun {
public:
  explicit OracleRun(const Scene& scene) : run_(scene, step_of(scene)), step_(step_of(scene)) {}
  void step() { run_.step(); }
  Sample sample() { return run_.sample(); }
  Sample step_and_sample() {
    const Sample now = run_.sample();
    run_.step();
    return now;
  }
  GranuleTable granules() { return run_.granules(); }
  double time_step() const { return step_; }

private:
  ReferenceRun run_;
  double step_;
};

/// All steps of the scene.
template <class Run> void run_all(Run& run, const Scene& scene) {
  for (std::int64_t n = steps_of(scene); n > 0; --n) run.step();
}

/// The longer versions of tests, by GRANDAMP_FULL=1 in the environment.
inline bool full_tests() {
  const char* value = std::getenv("GRANDAMP_FULL");
  return value && *value && *value != '0';
}

inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector3 difference(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vector3& a) {
  return std::sqrt(dot(a, a));
}

/// What is left of the energy balance, over the largest of the work put in and the initial energies (without the
/// gravitational one).
inline double ledger_residual(const Sample& start, const Sample& end) {
  const auto total = [](const StoredEnergy& e) { return e.kinetic + e.gravitational + e.elastic + e.structure; };
  const Ledger& l = end.ledger;
  const double losses = l.structural_damping + l.normal_granule + l.normal_wall + l.friction_granule + l.friction_wall;
  const double balance = total(end.stored) + losses - total(start.stored) - l.work_in;
  const StoredEnergy& first = start.stored;
  return balance / std::max(std::abs(l.work_in), first.kinetic + first.elastic + first.structure);
}

} // namespace grandamp::test
