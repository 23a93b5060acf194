// Many granules: struck from rest, at rest, jammed, flung, of sizes far apart.
#include "tests/hard_cases/scenes.hpp"
#include "tests/hard_cases/watch.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// The case under all choices; `use` sees each run's figures.
template <class Use>
void run_all_choices(CaseReport& report, Scene (*make)(std::uint64_t, bool), const WatchOptions& options,
                     const Bounds& bounds, const Use& use) {
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    const Figures figures = watch(make(choice.seed, full_tests()), choice, options);
    report.add(choice, figures, bounds, use(choice, figures));
  }
}

const auto nothing_more = [](const Choice&, const Figures&) { return std::string(); };

} // namespace

TEST_CASE("hard cases: granules at rest in an enclosure that jerks to 5 m/s") {
  WatchOptions options;
  options.audit_every = options.audit_every_if_missing = 1;
  for (const HardScene& jerked : {HardScene{"gas at rest, jerked", jerked_gas}, {"bed at rest, jerked", jerked_bed}}) {
    CaseReport report(jerked.name);
    std::int64_t paper_missed = 0;
    run_all_choices(report, jerked.make, options, {}, [&](const Choice& choice, const Figures& figures) {
      if (choice.policy == ListPolicy::predicted) paper_missed += figures.missed;
      return std::string();
    });
    CHECK(paper_missed > 0);
  }
}

TEST_CASE("hard cases: a bed at rest loses its motion to a floor and stays there") {
  CaseReport report("bed at rest");
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    const Scene scene = resting_bed(choice.seed, full_tests());
    // Kinetic energy per granule over m g d, and the centre of mass, look by look.
    std::vector<double> energies;
    std::vector<Vector3> centres;
    const double unit = scene.populations[0].mass * 9.81 * 2.0 * scene.populations[0].radius *
                        static_cast<double>(scene.populations[0].count);
    WatchOptions options;
    if (full_tests()) options.sample_every = 50;
    options.on_look = [&](const GranuleTable& granules, const Sample& sample) {
      energies.push_back(sample.stored.kinetic / unit);
      Vector3 centre{};
      for (const Vector3& p : granules.position)
        for (std::size_t k = 0; k < 3; ++k) centre[k] += p[k] / static_cast<double>(granules.position.size());
      centres.push_back(centre);
    };
    const Figures figures = watch(scene, choice, options);
    const std::size_t half = energies.size() / 2, last = energies.size() - 1;
    double floor = 0.0;
    for (std::size_t k = half + half / 2; k <= last; ++k) floor = std::max(floor, energies[k]);
    const double creep =
        length(difference(centres[last], centres[half + half / 2])) / (2.0 * scene.populations[0].radius);
    report.add(choice, figures, {}, fmt::format("last quarter: kinetic {:.1e} m g d, creep {:.1e} d", floor, creep));
    if (choice.friction == FrictionLaw::none) continue; // nothing holds the granules back from sliding on
    CHECK(floor <= 1.0e-6);
    CHECK(creep <= 1.0e-4);
  }
}

TEST_CASE("hard cases: jammed at 62 percent and shaken at 50 g") {
  CaseReport report("jammed");
  WatchOptions options;
  options.looks = 30;
  options.audit_every_if_missing = 50;
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    report.add(choice, watch(jammed_box(choice.seed, full_tests()), choice, options));
  }
}

TEST_CASE("hard cases: a dilute gas flung at resonance from a cold start is never silent about its speeds") {
  CaseReport report("flung at resonance");
  WatchOptions every_step; // a contact lasts eight steps
  every_step.audit_every_if_missing = full_tests() ? 10 : 1;
  run_all_choices(report, flung_gas, every_step, {}, [](const Choice&, const Figures& figures) {
    CHECK((figures.max_closing <= figures.assumed_closing || figures.warned_closing));
    return std::string(figures.warned_closing ? "told of the closing speeds" : "");
  });
  // The step rests on a closing speed that is far too low: a warning, then the guard.
  for (const double assumed : {0.3, 1.0e-3}) {
    Choice choice;
    Scene scene = flung_gas(1, full_tests());
    scene.time.impact_speed = assumed;
    const Figures figures = watch(scene, choice);
    CAPTURE(figures.stopped);
    CHECK(figures.not_finite == 0);
    const double limit = assumed * std::pow(8.0 / 3.5, 5.0);
    const bool stopped = figures.stopped.find("granules closed at") == 0;
    CHECK(stopped == (figures.max_closing > limit));
    CHECK((stopped || figures.warned_closing));
    CHECK(stopped == (assumed < 0.01));
    report.remark(fmt::format("assumed {} m/s, met {:.3g} m/s: {}", assumed, figures.max_closing,
                              figures.stopped.empty() ? "warned" : "stopped: " + figures.stopped));
  }
}

TEST_CASE("hard cases: sizes 1 to 10 in one shaken bed") {
  CaseReport report("sizes 1:10");
  WatchOptions options;
  options.looks = 30;
  options.audit_every_if_missing = 50;
  run_all_choices(report, size_contrast, options, {}, nothing_more);
}

TEST_CASE("hard cases: one granule 20 times as wide among thousands") {
  CaseReport report("one big granule");
  WatchOptions options;
  options.looks = 10;
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    const Figures figures = watch(one_big(choice.seed, false), choice, options);
    report.add(choice, figures, {}, fmt::format("{:.3g} us per step", figures.microseconds_per_step));
  }
}

TEST_CASE("hard cases: one granule 20 times as wide among 100,000") {
  if (!full_tests()) return;
  CaseReport report("one in 100,000");
  WatchOptions options;
  options.looks = 4;
  options.audit_every = 100; // of all 5e9 pairs
  for (const Choice& choice : {Choice{}, Choice{.friction = FrictionLaw::spring, .integrator = Integrator::verlet}}) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    const Figures figures = watch(one_big(choice.seed, true), choice, options);
    report.add(choice, figures, {},
               fmt::format("{:.3g} us per step, {:.3g} ns per granule", figures.microseconds_per_step,
                           1.0e3 * figures.microseconds_per_step / static_cast<double>(figures.granules)));
  }
}

TEST_CASE("hard cases: jammed and damped so strongly that nothing rebounds") {
  CaseReport report("jammed, e = 0.1");
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const bool tension : {true, false}) {
      Choice choice;
      choice.integrator = integrator;
      const std::string settings = told(choice);
      CAPTURE(settings);
      CAPTURE(tension);
      Scene scene = jammed_box(1, full_tests());
      scene.contact.tension = tension;
      for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) constants->restitution = 0.1;
      WatchOptions options;
      options.looks = 30;
      report.add(choice, watch(scene, choice, options), {}, tension ? "tension" : "no tension");
    }
}
