// States that somebody spoiled, a field at a time: refused, or run on without harm; never a crash, and none that hangs.
#include "solver/errors.hpp"
#include "solver/run_state.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <random>
#include <type_traits>

using namespace grandamp;
using namespace grandamp::test;

namespace {

class Spoiler {
public:
  /// Spoils one field. Its name.
  std::string spoil(RunState& state) {
    std::size_t fields = 0, next = 0;
    visit_fields(state, [&fields](const FieldInfo&, const auto&) { ++fields; });
    const std::size_t which = below(fields);
    std::string name;
    visit_fields(state, [&](const FieldInfo& info, auto& value) {
      if (next++ != which) return;
      name = info.name;
      change(value);
    });
    return name;
  }

private:
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }

  template <class T> T any(T near) {
    using Limits = std::numeric_limits<T>;
    const T values[] = {T{0},
                        T{1},
                        static_cast<T>(near + 1),
                        static_cast<T>(near - 1),
                        Limits::max(),
                        Limits::min(),
                        Limits::lowest(),
                        static_cast<T>(near * 2),
                        static_cast<T>(near / 2)};
    if constexpr (std::is_same_v<T, double>) {
      const double more[] = {1e300, -1e300, Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), -near, 1e9};
      if (below(2) == 0) return more[below(std::size(more))];
    }
    return values[below(std::size(values))];
  }

  void change(bool& value) { value = !value; }
  void change(double& value) { value = any(value); }
  void change(std::int64_t& value) { // sums of two such stay numbers: a checkpoint holds no others that are let in
    const std::int64_t values[] = {0, 1, -1, value + 1, value - 1, std::int64_t{1} << 40, -5, std::int64_t{1} << 62};
    value = values[below(std::size(values))];
  }
  template <class T> void change(std::vector<T>& values) {
    switch (below(5)) {
    case 0:
      values.clear();
      return;
    case 1:
      values.resize(values.size() + 1 + below(3));
      return;
    case 2:
      if (!values.empty()) values.pop_back();
      return;
    default:
      if (values.empty()) return;
      const std::size_t at = below(values.size());
      values[at] = below(2) == 0 ? values[below(values.size())] : any(values[at]);
    }
  }

  std::mt19937_64 random_{3};
};

Scene scene_with(int kind) {
  Scene scene = table_5(40, 1.0);
  scene.time.step = 1.0e-5;
  scene.time.duration = 0.05;
  if (kind == 1) {
    scene.contact.friction = FrictionLaw::spring;
    scene.contact.granule.tangential_stiffness = 0.9e7;
    scene.contact.wall->tangential_stiffness = 1.1e7;
    scene.time.integrator = Integrator::verlet;
    scene.time.step = 5.0e-6;
  } else if (kind == 2) {
    scene.verlet.policy = ListPolicy::displacement;
    scene.verlet.audit = 5;
    scene.excitation = {};
    scene.structure->displacement = 1e-3;
  } else if (kind == 3) {
    scene.verlet.policy = ListPolicy::predicted;
  }
  return scene;
}

} // namespace

TEST_CASE("damaged states are refused, or run on without harm") {
  RunOptions options;
  options.threads = 1;
  options.isa = "generic";
  Spoiler spoiler;
  int refused = 0, guarded = 0, harmless = 0;
  for (int kind = 0; kind < 4; ++kind) {
    const Scene scene = scene_with(kind);
    Simulation run(scene, options);
    for (int k = 0; k < 800; ++k) run.step();
    const RunState good = run.state();
    for (int k = 0; k < (full_tests() ? 5000 : 500); ++k) {
      RunState bad = good;
      const std::string field = spoiler.spoil(bad);
      CAPTURE(field);
      CAPTURE(k);
      try {
        Simulation again(scene, bad, options);
        for (int step = 0; step < 60 && !again.finished(); ++step) again.step();
        again.sample();
        again.granules();
        again.response();
        again.state();
        ++harmless;
      } catch (const StateError&) {
        ++refused;
      } catch (const GuardError&) {
        ++guarded;
      }
    }
  }
  MESSAGE(refused << " refused, " << guarded << " stopped by a guard, " << harmless << " run on");
  CHECK(refused > 300);
}
