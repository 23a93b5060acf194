// What an integrator may do to the energy of one contact by itself, at a given number of steps to it.
#pragma once

#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>

namespace grandamp::test {

/// Over the energy at the start.
struct Allowance {
  double during = 0.0; ///< largest rise of kinetic and elastic energy together at any step of a contact
  double after = 0.0;  ///< and once it is over
};

/// The integrator's own error on energy: an elastic, frictionless head-on hit at T_c / `steps`, the worst of many
/// phases of entry.
template <class Run> Allowance energy_allowance(Integrator integrator, double steps = 8.0) {
  Allowance worst;
  for (int p = 0; p < 40; ++p) {
    Scene scene = two_granules(1.5e-3, 2.5, 0.0);
    const double step = pair_contact_duration(scene, 5.0) / steps;
    scene = two_granules(1.5e-3, 2.5, 5.0 * step * (1.0 + p / 40.0));
    make_lossless(scene);
    scene.time.integrator = integrator;
    use_step(scene, step);
    Run run(scene);
    const double first = run.sample().stored.kinetic;
    for (std::int64_t n = steps_of(scene); n >= 0; --n) {
      const StoredEnergy now = run.sample().stored;
      const double rise = (now.kinetic + now.elastic) / first - 1.0;
      worst.during = std::max(worst.during, rise);
      if (n == 0) worst.after = std::max(worst.after, rise);
      if (n > 0) run.step();
    }
  }
  return worst;
}

} // namespace grandamp::test
