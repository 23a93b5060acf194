// As many granule-steps of the hard cases as one asks for: what the sanitizers are given to chew on.
#include "tests/hard_cases/scenes.hpp"
#include "tests/hard_cases/watch.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE("hard cases: as many granule-steps as GRANDAMP_GRANULE_STEPS asks for") {
  const char* asked = std::getenv("GRANDAMP_GRANULE_STEPS");
  if (asked == nullptr) return;
  const double wanted = std::atof(asked);
  REQUIRE(wanted > 0.0);
  const auto begun = std::chrono::steady_clock::now();
  double done = 0.0;
  std::int64_t runs = 0, stopped = 0;
  for (std::uint64_t round = 0; done < wanted; ++round)
    for (const HardScene& scene : hard_scenes())
      for (Choice choice : pairwise_choices()) {
        if (done >= wanted) break;
        choice.seed += 3 * round;
        const std::string settings = told(choice);
        CAPTURE(scene.name);
        CAPTURE(settings);
        WatchOptions options;
        options.sample_every = 10;
        options.looks = 20;
        options.audit_every = options.audit_every_if_missing = 500;
        const Figures figures = watch(scene.make(choice.seed, false), choice, options);
        done += static_cast<double>(figures.granules) * static_cast<double>(figures.steps);
        ++runs;
        if (may_miss(choice.policy)) {
          stopped += figures.stopped.empty() ? 0 : 1;
          continue;
        }
        CHECK(figures.stopped == "");
        CHECK(figures.not_finite == 0);
        CHECK(figures.nearest_wall >= 0.0);
        CHECK(figures.missed == 0);
      }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  CaseReport report("endurance");
  report.remark(
      fmt::format("{:.4g} granule-steps in {} runs, {} of them stopped by a guard (lists that may miss), {:.0f} s, "
                  "{:.3g} granule-steps per second",
                  done, runs, stopped, seconds, done / seconds));
  CHECK(done >= wanted);
}
