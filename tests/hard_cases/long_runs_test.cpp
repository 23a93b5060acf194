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
  scene.time.duration = 1.0; // until told otherwise
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
  options.sample_every = full_tests() ? 50 : 10;
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
  // Without losses Verlet is leapfrog. Steps above 8 are not a loosening: the drift at 8 is told, too.
  std::vector<double> rms;
  for (const double steps : {8.0, 16.0, 32.0}) {
    double sum = 0.0, squares = 0.0, worst = 0.0;
    for (const std::uint64_t seed : {1, 2, 3}) {
      choice.steps_per_contact = steps;
      choice.seed = seed;
      choice.integrator = seed == 3 ? Integrator::verlet : Integrator::leapfrog;
      Figures figures;
      const double here = drift(choice, duration, &figures);
      report.add(choice, figures, {}, fmt::format("drift {:.2e}", here));
      sum += here / 3.0;
      squares += here * here / 3.0;
      worst = std::max(worst, std::abs(here));
    }
    rms.push_back(std::sqrt(squares));
    report.remark(
        fmt::format("{} steps a contact: drift {:.2e} in the mean of 3 seeds, {:.2e} at worst", steps, sum, worst));
    CHECK(worst < (steps < 16.0 ? 1.0e-2 : 1.0e-3));
  }
  // It walks at random from hit to hit; the size of the strides falls as the square of the step.
  CHECK(rms[1] < 0.5 * rms[0]);
  CHECK(rms[2] < 0.5 * rms[1]);
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
    scene.verlet.skin = may_miss_contacts(choice.policy) ? 0.3 : 0.03; // many lists, but none that misses much
    const double seconds = full_tests() ? 10.0 : 0.1;
    check_cut(scene, static_cast<std::int64_t>(seconds / *scene.time.step), 20, 1, 2);
  }
}
