// The list holds every pair within its reach, each once, whatever the number of pairs in a block's classes.
#include "solver/run_state.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE("every pair within reach is listed once, in lists from nothing to many pairs") {
  std::size_t lists = 0, pairs = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::size_t count = 6 + seed / 2;
    Scene scene = gas(count, 0.016, 1.0, seed);
    scene.time.step = 5.0e-6;
    scene.time.duration = 0.015;
    scene.verlet.skin = 0.4;
    scene.time.impact_speed = 8.0;
    RunOptions options;
    options.threads = 1;
    Simulation run(scene, options);
    while (!run.finished()) {
      run.step();
      const RunState s = run.state();
      if (s.list_age != 1) continue;
      ++lists;
      std::set<std::pair<std::uint32_t, std::uint32_t>> listed;
      for (std::size_t k = 0; k < s.list.pairs.size(); k += 2) {
        REQUIRE(s.list.pairs[k] < s.list.pairs[k + 1]);
        REQUIRE(s.list.pairs[k + 1] < count);
        CHECK(listed.emplace(s.list.pairs[k], s.list.pairs[k + 1]).second);
      }
      pairs += listed.size();
      const double moved = 2.0 * s.list_travelled; // in the one step since the list was built
      for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t j = i + 1; j < count; ++j) {
          const double gap =
              std::hypot(s.position[3 * i] - s.position[3 * j], s.position[3 * i + 1] - s.position[3 * j + 1],
                         s.position[3 * i + 2] - s.position[3 * j + 2]) -
              s.radius[i] - s.radius[j];
          if (gap < s.skin - moved) CHECK(listed.contains({i, j}));
        }
    }
  }
  MESSAGE(lists << " lists, " << pairs << " pairs");
  CHECK(lists > 300);
}
