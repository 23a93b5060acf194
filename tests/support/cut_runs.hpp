// A run that is cut and put back, again and again, beside one that never was: every field of the state must agree.
#pragma once

#include "solver/errors.hpp"
#include "solver/run_state.hpp"
#include "tests/support/runs.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace grandamp::test {

/// Names of the fields that differ in a bit; empty if none does.
inline std::string differences(const RunState& a, const RunState& b) {
  std::vector<std::string> bytes;
  const auto as_bytes = [&bytes](const FieldInfo&, const auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Value>)
      bytes.emplace_back(reinterpret_cast<const char*>(&value), sizeof(value));
    else
      bytes.emplace_back(reinterpret_cast<const char*>(value.data()), value.size() * sizeof(value[0]));
  };
  visit_fields(a, as_bytes);
  const std::vector<std::string> first = std::exchange(bytes, {});
  visit_fields(b, as_bytes);
  std::string names;
  std::size_t next = 0;
  visit_fields(a, [&](const FieldInfo& info, const auto&) {
    if (first[next] != bytes[next]) names += std::string(info.name) + ' ';
    ++next;
  });
  return names;
}

inline bool same(const Sample& a, const Sample& b) {
  return std::memcmp(&a, &b, sizeof(Sample)) == 0;
}

inline RunOptions with_threads(int threads) {
  RunOptions options;
  options.threads = threads;
  return options;
}

inline bool may_miss_contacts(ListPolicy policy) {
  return policy == ListPolicy::predicted || policy == ListPolicy::fixed;
}

/// Steps, with a sample every 37. What a guard said, if one stopped it.
inline std::string go(Simulation& run, std::int64_t steps) {
  try {
    for (; steps > 0; --steps) {
      if (run.step_number() % 37 == 0)
        run.step_and_sample();
      else
        run.step();
    }
  } catch (const GuardError& error) {
    return error.what();
  }
  return "";
}

/// A run of the scene, cut `cuts` times at uneven places, on `threads` and then `others` in turn. Should a guard stop
/// it, it stops both alike.
inline void check_cut(Scene scene, std::int64_t steps, int cuts, int threads = 1, int others = 1) {
  scene.time.duration = static_cast<double>(steps) * *scene.time.step;
  Simulation whole(scene, with_threads(threads));
  REQUIRE(whole.plan().steps == steps);
  Simulation parts(scene, with_threads(threads));
  std::int64_t done = 0;
  for (int cut = 1; cut <= cuts; ++cut) {
    const std::int64_t until = steps * cut / (cuts + 1) + cut % 3;
    const std::string stopped = go(whole, until - done);
    CHECK(go(parts, until - done) == stopped);
    CAPTURE(stopped);
    if (!stopped.empty()) {
      CHECK(may_miss_contacts(scene.verlet.policy));
      return;
    }
    done = until;
    const RunState state = parts.state();
    parts = Simulation(scene, state, with_threads(cut % 2 == 1 ? others : threads));
    CHECK(differences(state, parts.state()) == "");
    CHECK(differences(whole.state(), state) == "");
  }
  CHECK(go(whole, steps - done) == "");
  CHECK(go(parts, steps - done) == "");
  CHECK(parts.finished());
  const RunState end = whole.state();
  CHECK(differences(end, parts.state()) == "");
  CHECK(end.builds > 1);
  CHECK(same(whole.sample(), parts.sample()));
  const GranuleTable a = whole.granules(), b = parts.granules();
  CHECK(a.position == b.position);
  CHECK(a.velocity == b.velocity);
  CHECK(a.spin == b.spin);
  const ResponseStatistics r = whole.response(), t = parts.response();
  CHECK(std::memcmp(&r.rms_displacement, &t.rms_displacement, sizeof(double)) == 0);
  CHECK(r.cycle_amplitudes == t.cycle_amplitudes);
  CHECK(whole.verlet().contacts_per_granule == parts.verlet().contacts_per_granule);
  CHECK(whole.verlet().mean_interval == parts.verlet().mean_interval);
}

} // namespace grandamp::test
