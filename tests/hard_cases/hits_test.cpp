// Hits of two granules, and of a granule and a wall: every angle, speeds apart by thousands, any restitution and
// friction, sizes 1:10.
#include "tests/hard_cases/scenes.hpp"
#include "tests/hard_cases/watch.hpp"
#include "tests/support/energy_allowance.hpp"
#include "tests/support/hits.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// The worst gain of kinetic energy of a single hit, over its first.
double worst_gain(const Hits& hits, const std::vector<double>& before, const std::vector<double>& after) {
  double worst = -1.0;
  for (std::size_t k = 0; k < before.size(); ++k) worst = std::max(worst, after[k] / before[k] - 1.0);
  REQUIRE(before.size() == static_cast<std::size_t>(Hits::angles));
  REQUIRE(hits.scene.populations[0].count >= before.size());
  return worst;
}

struct Rebound {
  double mean = 0.0, worst = 0.0; ///< of e less the exact one
};

/// Head-on hits at `phases` phases of entry, the second granule `ratio` times the first (0: the floor).
Rebound rebound(const Choice& choice, double ratio, double speed, double restitution) {
  constexpr int phases = 32;
  Rebound errors;
  for (int p = 0; p < phases; ++p) {
    Hits hits(ratio, restitution, 0.0, speed, choice.steps_per_contact, (p + 0.5) / phases);
    Scene scene = hits.scene;
    Population& all = scene.populations[0];
    const std::size_t each = ratio > 0.0 ? 2 : 1;
    for (auto* rows : {&all.positions, &all.velocities, &all.spins}) rows->resize(each);
    for (auto* values : {&all.radii, &all.masses}) values->resize(each);
    all.count = each;
    scene.contact.friction = FrictionLaw::none;
    for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) constants->friction.reset();
    scene.time.integrator = choice.integrator;
    SolverRun run(scene);
    run_all(run, scene);
    REQUIRE(run.sample().contacts == 0);
    const GranuleTable end = run.granules();
    const double apart = end.velocity[0][2] - (each > 1 ? end.velocity[1][2] : 0.0);
    const double error = apart / speed - restitution;
    errors.mean += error / phases;
    errors.worst = std::max(errors.worst, std::abs(error));
  }
  return errors;
}

/// How far e may be off at a step, by restitution: the stated error, which the test holds every hit to. Leapfrog takes
/// the damping from a velocity half a step old, which shows where the damping is strong.
struct StatedError {
  double restitution;
  Rebound leapfrog_8, leapfrog_16, verlet_8, verlet_16;

  const Rebound& at(const Choice& choice) const {
    if (choice.integrator == Integrator::leapfrog) return choice.steps_per_contact < 16.0 ? leapfrog_8 : leapfrog_16;
    return choice.steps_per_contact < 16.0 ? verlet_8 : verlet_16;
  }
};
constexpr StatedError stated_errors[] = {{0.05, {0.026, 0.029}, {0.014, 0.016}, {0.008, 0.012}, {0.002, 0.004}},
                                         {0.3, {0.021, 0.036}, {0.012, 0.019}, {0.028, 0.041}, {0.008, 0.017}},
                                         {0.6, {0.009, 0.029}, {0.004, 0.011}, {0.027, 0.046}, {0.007, 0.012}},
                                         {0.9, {0.0005, 0.015}, {0.0004, 0.003}, {0.008, 0.013}, {0.003, 0.005}},
                                         {1.0, {0.0003, 0.006}, {0.0001, 0.001}, {0.0003, 0.006}, {0.0001, 0.001}}};

std::vector<double> few_or_all(std::vector<double> all, std::vector<double> few) {
  return full_tests() ? std::move(all) : std::move(few);
}

void check_hits(const std::string& name, const std::vector<double>& ratios) {
  CaseReport report(name);
  for (const Choice& choice : pairwise_choices()) {
    const double allowance = energy_allowance<SolverRun>(choice.integrator, choice.steps_per_contact).after;
    double gain = -1.0;
    Figures worst;
    for (const double ratio : ratios)
      for (const double speed : few_or_all({0.01, 0.1, 1.0, 10.0, 50.0}, {0.01, 50.0}))
        for (const double restitution : few_or_all({0.05, 0.3, 0.6, 0.9, 1.0}, {0.05, 1.0}))
          for (const double friction : few_or_all({0.0, 0.1, 0.52, 2.0}, {0.1, 2.0})) {
            CAPTURE(ratio);
            CAPTURE(speed);
            CAPTURE(restitution);
            CAPTURE(friction);
            const double phase = static_cast<double>(choice.seed) / 3.7;
            Hits hits(ratio, restitution, friction, speed, choice.steps_per_contact, phase);
            std::vector<double> before, after;
            WatchOptions options;
            options.looks = 2;
            options.audit_every = options.audit_every_if_missing = 10;
            std::int64_t contacts = -1;
            options.on_look = [&](const GranuleTable& granules, const Sample& sample) {
              after = energies(hits, granules);
              if (before.empty()) before = after;
              contacts = sample.contacts;
            };
            const Figures figures = watch(hits.scene, choice, options);
            CHECK(figures.stopped == "");
            CHECK(contacts == 0);
            const double here = worst_gain(hits, before, after);
            CHECK(here <= allowance);
            gain = std::max(gain, here);
            // Many scenes make one row: the worst of each figure.
            const Figures last = worst;
            worst = figures;
            worst.steps += last.steps;
            worst.not_finite += last.not_finite;
            worst.nearest_wall = std::min(worst.nearest_wall, last.nearest_wall);
            worst.rise = std::max(worst.rise, last.rise);
            worst.residual = std::max(worst.residual, last.residual);
            worst.momentum = std::max(worst.momentum, last.momentum);
            worst.angular = std::max(worst.angular, last.angular);
            worst.free_looks += last.free_looks;
            worst.audited += last.audited;
            worst.missed += last.missed;
            worst.missed_pair_steps += last.missed_pair_steps;
            worst.max_overlap = std::max(worst.max_overlap, last.max_overlap);
          }
    Bounds bounds;
    bounds.residual = residual_of_a_contact(choice);
    report.add(choice, worst, bounds,
               fmt::format("worst hit gains {:.2g} %, allowed {:.2g} %", 100.0 * gain, 100.0 * allowance));
  }
}

} // namespace

TEST_CASE("hard cases: hits at 90 angles, 0.01 to 50 m/s, restitution 0.05 to 1, friction to 2") {
  check_hits("hits of equals and on the floor", {0.0, 1.0});
}

TEST_CASE("hard cases: hits at size ratio 1 to 10, mass ratio 1 to 1000") {
  check_hits("hits at sizes 1:10", {10.0});
}

TEST_CASE("hard cases: restitution within the stated error of the step, the same for equals and for sizes 1 to 10") {
  CaseReport report("restitution");
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const double steps : {8.0, 16.0}) {
      Choice choice;
      choice.integrator = integrator;
      choice.steps_per_contact = steps;
      std::map<double, Rebound> by_restitution;
      for (const double ratio : {0.0, 1.0, 10.0})
        for (const double speed : {0.01, 1.0, 50.0})
          for (const StatedError& stated : stated_errors) {
            const double restitution = stated.restitution;
            CAPTURE(ratio);
            CAPTURE(speed);
            CAPTURE(restitution);
            const Rebound here = rebound(choice, ratio, speed, restitution);
            CHECK(std::abs(here.mean) <= stated.at(choice).mean);
            CHECK(here.worst <= stated.at(choice).worst);
            by_restitution[restitution].mean = std::max(by_restitution[restitution].mean, std::abs(here.mean));
            by_restitution[restitution].worst = std::max(by_restitution[restitution].worst, here.worst);
          }
      for (const auto& [restitution, errors] : by_restitution)
        report.remark(fmt::format(
            "{}, {} steps, e = {}: off by {:.4f} in the mean over phases of entry, {:.4f} at worst",
            integrator == Integrator::leapfrog ? "leapfrog" : "verlet", steps, restitution, errors.mean, errors.worst));
    }
}

TEST_CASE("hard cases: the step comes from the stiffest, lightest pair among sizes 1 to 10") {
  const Scene scene = size_contrast(1, false);
  const Plan plan = make_plan(scene);
  const double light = sphere_mass(0.5e-3), heavy = sphere_mass(5.0e-3);
  const double v = plan.impact_speed;
  const auto pair = [&](double r, double s, double m, double n) {
    return contact_duration(m * n / (m + n), 1.0e7 * std::sqrt(2.0 * r * s / (r + s) / 3.0e-3), v);
  };
  const auto wall = [&](double r, double m) { return contact_duration(m, 1.3e7 * std::sqrt(r / 3.0e-3), v); };
  const double shortest = std::min({pair(0.5e-3, 0.5e-3, light, light), pair(0.5e-3, 5.0e-3, light, heavy),
                                    pair(5.0e-3, 5.0e-3, heavy, heavy), wall(0.5e-3, light), wall(5.0e-3, heavy)});
  CHECK(plan.contact_duration == doctest::Approx(shortest).epsilon(1.0e-12));
  CHECK(plan.time_step <= shortest / 8.0);
  CHECK(plan.time_step > shortest / 8.5);
}
