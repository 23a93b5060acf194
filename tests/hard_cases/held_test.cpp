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
        Scene scene = held(count == 3 ? ring(3) : all_around(count), spin, 10.0, choice.steps_per_contact);
        scene.time.step.reset(); // the program's own choice: springs may want a shorter one
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
        const double turning = 0.2 * scene.populations[0].masses[0] * dot(spin, spin) * 1.5e-3 * 1.5e-3;
        const Figures figures = watch(scene, choice, options);
        Bounds bounds;
        bounds.residual = 1.0; // the spin is gone in a step or two, and energies are told at whole steps
        report.add(choice, figures, bounds,
                   fmt::format("{} holders: energy rises by {:.1e}, {:.1e} of it left", count, rise / turning,
                               left / turning));
        // In mixed precision the energy that presses is told to float's rounding.
        const double rounding = choice.precision == Precision::mixed ? 1.0e-6 : 1.0e-9;
        CHECK(rise / turning <= (choice.friction == FrictionLaw::spring ? allowed_rise(choice) : rounding));
      }
}

TEST_CASE("hard cases: damping by linear dashpots of twelve neighbours at once takes energy and gives none") {
  CaseReport report("twelve dashpots");
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const double friction : {0.0, 10.0}) {
      Choice choice;
      choice.integrator = integrator;
      choice.friction = friction > 0.0 ? FrictionLaw::spring : FrictionLaw::none;
      const std::string settings = told(choice);
      CAPTURE(settings);
      Scene scene = held(all_around(12), {10.0, -30.0, 20.0}, friction);
      scene.time.step.reset();
      scene.populations[0].velocities[0] = {1.0e-3, -2.0e-3, 0.5e-3};
      scene.contact.damping = NormalDamping::linear;
      for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
        constants->alpha.reset();
        constants->normal_damping = 20.0; // so strong that it sets the step
      }
      double first = -1.0, least = 0.0, rise = 0.0, pressed = 0.0;
      WatchOptions options;
      options.looks = 1 << 20;
      options.on_look = [&](const GranuleTable&, const Sample& now) {
        if (first < 0.0) {
          first = least = now.stored.kinetic;
          pressed = now.stored.elastic;
        }
        const double energy = now.stored.kinetic + now.stored.elastic - pressed;
        rise = std::max(rise, energy - least);
        least = std::min(least, energy);
      };
      const Figures figures = watch(scene, choice, options);
      Bounds bounds;
      bounds.residual = 1.0;
      report.add(choice, figures, bounds, fmt::format("energy rises by {:.1e}", rise / first));
      CHECK(rise / first <= allowed_rise(choice));
    }
}
