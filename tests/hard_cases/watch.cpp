#include "tests/hard_cases/watch.hpp"

#include "solver/measures.hpp"
#include "tests/support/energy_allowance.hpp"
#include "tests/support/momenta.hpp"

#include <chrono>
#include <cstdio>
#include <map>

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace grandamp::test {

namespace {

std::vector<double> masses_of(const Scene& scene) {
  std::vector<double> masses;
  for (const Population& population : scene.populations)
    for (std::size_t i = 0; i < population.count; ++i) masses.push_back(mass_of(population, i));
  return masses;
}

/// Distance of a centre from the nearest wall, m.
double to_wall(const Enclosure& enclosure, const Vector3& p) {
  if (enclosure.shape == EnclosureShape::box) {
    double nearest = enclosure.size[0];
    for (std::size_t k = 0; k < 3; ++k) nearest = std::min({nearest, p[k], enclosure.size[k] - p[k]});
    return nearest;
  }
  const auto axis = static_cast<std::size_t>(enclosure.axis);
  double off_axis = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    if (k != axis) off_axis = std::hypot(off_axis, p[k] - 0.5 * enclosure.diameter);
  return std::min({0.5 * enclosure.diameter - off_axis, p[axis], enclosure.height - p[axis]});
}

/// Keeps what the looks at all granules need from one to the next.
class Looks {
public:
  /// `balances`: every step is told, and so impulses can be summed.
  Looks(const Scene& scene, Figures& figures, bool balances)
      : scene_(scene), figures_(figures), balances_(balances), masses_(masses_of(scene)) {
    for (const double mass : masses_) total_mass_ += mass;
  }

  void look(const GranuleTable& now, const Sample& sample, double step) {
    if (masses_.empty()) return;
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        for (const double value : {now.position[i][k], now.velocity[i][k], now.spin[i][k]})
          figures_.not_finite += std::isfinite(value) ? 0 : 1;
      figures_.nearest_wall =
          std::min(figures_.nearest_wall, to_wall(scene_.enclosure, now.position[i]) / now.radius[i]);
    }
    if (!balances_) return;
    const Momenta momenta = test::momenta(now, masses_);
    if (looked_) compare(momenta, sample, step);
    before_ = momenta;
    // Half of this instant's kick is in the velocities told.
    for (std::size_t k = 0; k < 3; ++k) impulse_[k] = -0.5 * step * force_on_granules(sample, k);
    impulse_scale_ = 0.0;
    walls_ = false;
    looked_ = true;
  }

  /// After each step: the force that it took.
  void step(const Sample& sample, double step) {
    for (std::size_t k = 0; k < 3; ++k) {
      impulse_[k] += step * force_on_granules(sample, k);
      impulse_scale_ += step * (std::abs(total_mass_ * scene_.gravity[k]) + std::abs(sample.wall_force[k]));
      walls_ = walls_ || sample.wall_force[k] != 0.0;
    }
  }

private:
  double force_on_granules(const Sample& sample, std::size_t k) const {
    return total_mass_ * scene_.gravity[k] - sample.wall_force[k];
  }

  void compare(const Momenta& now, const Sample& sample, double step) {
    double off = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      off =
          std::hypot(off, now.linear[k] - before_.linear[k] - impulse_[k] - 0.5 * step * force_on_granules(sample, k));
    const double scale = std::max(now.linear_scale, before_.linear_scale) + impulse_scale_;
    if (scale > 0.0) figures_.momentum = std::max(figures_.momentum, off / scale);
    for (const double force : sample.wall_force) walls_ = walls_ || force != 0.0;
    const double angular_scale = std::max(now.angular_scale, before_.angular_scale);
    if (walls_ || !(angular_scale > 0.0)) return;
    ++figures_.free_looks;
    figures_.angular = std::max(figures_.angular, length(difference(now.angular, before_.angular)) / angular_scale);
  }

  const Scene& scene_;
  Figures& figures_;
  bool balances_;
  std::vector<double> masses_;
  double total_mass_ = 0.0;
  bool looked_ = false, walls_ = false;
  Momenta before_;
  Vector3 impulse_{};
  double impulse_scale_ = 0.0;
};

/// Energy, its balance, and its rises.
class Energies {
public:
  explicit Energies(Figures& figures) : figures_(figures) {}

  void add(const Sample& now) {
    if (!started_) start_ = now;
    const double lively = now.stored.kinetic + now.stored.elastic;
    scale_ = std::max(scale_, lively);
    const double passive = total(now.stored) - total(start_.stored) - now.ledger.work_in;
    if (!started_ || passive < least_) least_ = passive;
    started_ = true;
    if (scale_ > 0.0) figures_.rise = std::max(figures_.rise, (passive - least_) / scale_);

    const Ledger& l = now.ledger;
    const StoredEnergy &first = start_.stored, &stored = now.stored;
    const double losses =
        l.structural_damping + l.normal_granule + l.normal_wall + l.friction_granule + l.friction_wall;
    left_over_ = std::max(left_over_, std::abs(passive + losses));
    for (const double term :
         {l.work_in, l.structural_damping, l.normal_granule, l.normal_wall, l.friction_granule, l.friction_wall,
          stored.kinetic, stored.elastic, stored.structure, stored.gravitational - first.gravitational})
      largest_ = std::max(largest_, std::abs(term));
    if (largest_ > 0.0) figures_.residual = left_over_ / largest_;
  }

private:
  static double total(const StoredEnergy& e) { return e.kinetic + e.gravitational + e.elastic + e.structure; }

  Figures& figures_;
  bool started_ = false;
  Sample start_;
  double least_ = 0.0, scale_ = 0.0;
  double left_over_ = 0.0, largest_ = 0.0; // of the whole run: at its very beginning all terms are tiny
};

void take_statistics(const Simulation& simulation, Figures& figures) {
  const VerletStatistics verlet = simulation.verlet();
  figures.audited = verlet.audited;
  figures.missed = verlet.missed;
  figures.missed_pair_steps = verlet.missed_pair_steps;
  figures.max_overlap = simulation.guards().max_overlap;
  figures.max_closing = simulation.guards().max_closing;
  figures.steps = simulation.step_number();
}

std::string row(const std::string& name, const std::string& choice, const Figures& f, const std::string& note) {
  return fmt::format(
      "| {} | {} | {} | {} | {} | {:.3f} | {:.3g} / {:.3g} | {:.3g} | {:.1e} | {} | {} / {} | {:.3g} | {:.3g} / "
      "{:.3g} | {} |",
      name, choice, f.granules, f.steps, f.not_finite, f.nearest_wall, 100.0 * f.rise, 100.0 * f.allowed_rise,
      100.0 * f.residual, f.momentum, f.free_looks > 0 ? fmt::format("{:.1e}", f.angular) : "-", f.missed, f.audited,
      100.0 * f.max_overlap, f.max_closing, f.assumed_closing, note);
}

void print(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

} // namespace

double allowed_rise(const Choice& choice) {
  static std::map<std::pair<Integrator, double>, double> known;
  const auto key = std::pair(choice.integrator, choice.steps_per_contact);
  if (!known.contains(key))
    known[key] = energy_allowance<SolverRun>(choice.integrator, choice.steps_per_contact).during;
  return known[key];
}

Figures watch(Scene scene, const Choice& choice, const WatchOptions& options) {
  apply(choice, scene);
  scene.output.energy = true;
  scene.verlet.audit = may_miss(choice.policy) ? options.audit_every_if_missing : options.audit_every;
  Figures figures;
  figures.allowed_rise = allowed_rise(choice);
  SolverRun run(scene);
  Simulation& simulation = run.simulation();
  figures.granules = simulation.plan().granules;
  figures.assumed_closing = simulation.plan().impact_speed;
  const double step = simulation.plan().time_step;
  const std::int64_t every = std::max<std::int64_t>(1, simulation.plan().steps / options.looks);
  Looks looks(scene, figures, options.sample_every == 1);
  Energies energies(figures);
  double seconds = 0.0;
  try {
    while (!simulation.finished()) {
      const bool due = simulation.step_number() % every == 0;
      if (due) {
        const GranuleTable granules = simulation.granules();
        const Sample here = simulation.sample();
        looks.look(granules, here, step);
        if (options.on_look) options.on_look(granules, here);
      }
      const bool sampled = due || simulation.step_number() % options.sample_every == 0;
      const auto begun = std::chrono::steady_clock::now();
      Sample now;
      if (sampled)
        now = simulation.step_and_sample();
      else
        simulation.step();
      seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      if (options.sample_every == 1) looks.step(now, step);
      if (sampled) energies.add(now);
    }
    const Sample end = simulation.sample();
    const GranuleTable granules = simulation.granules();
    looks.look(granules, end, step);
    energies.add(end);
    if (options.on_look) options.on_look(granules, end);
  } catch (const GuardError& error) {
    figures.stopped = error.what();
  }
  take_statistics(simulation, figures);
  if (figures.steps > 0) figures.microseconds_per_step = 1.0e6 * seconds / static_cast<double>(figures.steps);
  for (const std::string& warning : simulation.take_warnings()) {
    figures.warned_closing = figures.warned_closing || warning.find("granules closed at") == 0;
    figures.warned_balance = figures.warned_balance || warning.find("the energy balance is off") == 0;
  }
  return figures;
}

void CaseReport::add(const Choice& choice, const Figures& f, const Bounds& bounds, const std::string& note) {
  const std::string settings = told(choice);
  CAPTURE(settings);
  print(row(name_, settings, f, f.stopped.empty() ? note : "stopped: " + f.stopped.substr(0, 60)));
  granule_steps_ += f.steps * static_cast<std::int64_t>(f.granules);
  ++runs_;
  if (f.missed > 0)
    misses_.push_back(fmt::format("{}: {} contacts for {} pair steps{}", settings, f.missed, f.missed_pair_steps,
                                  f.stopped.empty() ? "" : ", then a guard"));
  if (may_miss(choice.policy)) {
    // What follows a missed contact is the list's doing; a guard may say so, and must be the one to do it.
    if (!f.stopped.empty()) ++stopped_;
    CHECK((f.stopped.empty() || f.missed > 0));
    CHECK(f.not_finite == 0);
    if (f.missed > 0) return;
  }
  worst_.granules = std::max(worst_.granules, f.granules);
  worst_.steps = std::max(worst_.steps, f.steps);
  worst_.not_finite += f.not_finite;
  worst_.nearest_wall = std::min(worst_.nearest_wall, f.nearest_wall);
  if (f.rise / f.allowed_rise >= worst_.rise / std::max(1e-300, worst_.allowed_rise)) {
    worst_.rise = f.rise;
    worst_.allowed_rise = f.allowed_rise;
  }
  worst_.residual = std::max(worst_.residual, f.residual);
  worst_.momentum = std::max(worst_.momentum, f.momentum);
  worst_.angular = std::max(worst_.angular, f.angular);
  worst_.free_looks += f.free_looks;
  worst_.audited += f.audited;
  worst_.missed += f.missed;
  worst_.max_overlap = std::max(worst_.max_overlap, f.max_overlap);
  if (f.max_closing / f.assumed_closing >= worst_.max_closing / std::max(1e-300, worst_.assumed_closing)) {
    worst_.max_closing = f.max_closing;
    worst_.assumed_closing = f.assumed_closing;
  }

  if (!bounds.may_stop) CHECK(f.stopped == "");
  CHECK(f.not_finite == 0);
  CHECK(f.nearest_wall >= 0.0);
  if (bounds.rise) CHECK(f.rise <= f.allowed_rise);
  CHECK(f.residual <= bounds.residual);
  if (bounds.residual < 0.1) CHECK_FALSE(f.warned_balance); // no false alarm
  CHECK(f.momentum <= bounds.momentum);
  // Turns of both granules come from one arm and one force, in mixed precision rounded to float.
  CHECK(f.angular <= (choice.precision == Precision::mixed ? 1.0e-6 : bounds.angular));
  if (f.granules > 0) CHECK(f.audited > 0);
  CHECK(f.missed == 0);
}

void CaseReport::remark(const std::string& text) {
  print("> " + name_ + ": " + text);
}

CaseReport::~CaseReport() {
  if (runs_ > 0)
    print(row("**" + name_ + "**", fmt::format("worst of {}", runs_), worst_,
              stopped_ > 0 ? fmt::format("{} stopped by a guard, their lists having missed contacts", stopped_) : ""));
  for (const std::string& miss : misses_) remark("missed: " + miss);
}

} // namespace grandamp::test
