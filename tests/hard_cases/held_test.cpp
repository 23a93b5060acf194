// One granule in the grip of 3, 4, 6 and 12 heavy ones, spun: several caps of friction, or springs, act on it at once.
#include "tests/hard_cases/watch.hpp"
#include "tests/support/held_granule.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE("hard cases: a spun granule held by 3, 4, 6 and 12 others gains no energy") {
  CaseReport report("held and spun");
  for (const Choice& choice : pairwise_choices())
    for (const int count : {3, 4, 6, 12})
      for (const Vector3& spin : {Vector3{0.0, 0.0, 50.0}, Vector3{10.0, -30.0, 20.0}}) {
        const std::string settings = told(choice);
        CAPTURE(settings);
        CAPTURE(count);
        const Scene scene = held(count == 3 ? ring(3) : all_around(count), spin, 10.0, choice.steps_per_contact);
        // All motion is the spin: what the others and the springs have of it is counted, what presses is not.
        double first = -1.0, pressed = 0.0, least = 0.0, rise = 0.0, left = 0.0;
        WatchOptions options;
        options.looks = 1 << 20; // every step
        options.audit_every = options.audit_every_if_missing = 10;
        options.on_look = [&](const GranuleTable&, const Sample& now) {
          if (first < 0.0) {
            first = least = now.stored.kinetic;
            pressed = now.stored.elastic;
          }
          left = now.stored.kinetic + now.stored.elastic - pressed;
          rise = std::max(rise, left - least);
          least = std::min(least, left);
        };
        const Figures figures = watch(scene, choice, options);
        Bounds bounds;
        report.add(
            choice, figures, bounds,
            fmt::format("{} holders: energy rises by {:.1e}, {:.1e} of it left", count, rise / first, left / first));
        CHECK(rise / first <= (choice.friction == FrictionLaw::spring ? allowed_rise(choice) : 1.0e-9));
      }
}
