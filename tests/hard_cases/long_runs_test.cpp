// Runs whose difficulty is their length: energy without losses, cuts and resumptions.
#include "tests/hard_cases/scenes.hpp"
#include "tests/hard_cases/watch.hpp"
#include "tests/support/cut_runs.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// 300 elastic granules without friction, so dilute that each meets some fifty others in a million steps.
Scene lossless_gas(std::uint64_t seed) {
  Scene scene = gas(300, 0.08, 0.5, 90 + seed);
  make_lossless(scene);
  scene.contact.friction = FrictionLaw::none;
  return scene;
}

/// Relative change of the energy over `duration`.
double drift(const Choice& choice, double duration, Figures* figures = nullptr) {
  Scene scene = lossless_gas(choice.seed);
  scene.time.duration = duration;
  double first = -1.0, last = 0.0;
  WatchOptions options;
  options.looks = 50;
  options.audit_every = options.audit_every_if_missing = 5000;
  options.on_look = [&](const GranuleTable&, const Sample& now) {
    last = now.stored.kinetic + now.stored.elastic;
    if (first < 0.0) first = last;
  };
  const Figures seen = watch(scene, choice, options);
  if (figures) *figures = seen;
  return last / first - 1.0;
}

} // namespace

TEST_CASE("hard cases: no losses, 300 granules - the energy drifts little, and less as the step shrinks") {
  CaseReport report("no losses");
  Choice choice;
  choice.friction = FrictionLaw::none;
  const Plan plan = make_plan(lossless_gas(1));
  const double step = plan.contact_duration / 8.0;
  const double duration = (full_tests() ? 1.0e6 : 5.0e4) * step;
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    for (const double steps : {8.0, 16.0, 32.0}) {
      double sum = 0.0, worst = 0.0;
      for (const std::uint64_t seed : {1, 2, 3}) {
        choice.integrator = integrator;
        choice.steps_per_contact = steps;
        choice.seed = seed;
        Figures figures;
        const double here = drift(choice, duration, &figures);
        Bounds bounds;
        report.add(choice, figures, bounds, fmt::format("drift {:.2e}", here));
        sum += here / 3.0;
        worst = std::max(worst, std::abs(here));
      }
      report.remark(fmt::format("{}, {} steps: drift {:.2e} in the mean of 3 seeds, {:.2e} at worst",
                                integrator == Integrator::leapfrog ? "leapfrog" : "verlet", steps, sum, worst));
    }
  }
}

TEST_CASE("hard cases: a run cut and resumed 20 times, on 1 and 2 threads in turn, keeps its bits") {
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    Scene scene = table_5(12, 1.0);
    apply(choice, scene);
    scene.time.step = 1.0e-5;
    if (choice.friction == FrictionLaw::spring) scene.time.step = 5.0e-6;
    scene.verlet.audit = 500;
    const double seconds = full_tests() ? 10.0 : 0.05;
    check_cut(scene, static_cast<std::int64_t>(seconds / *scene.time.step), 20, 1, 2);
  }
}
