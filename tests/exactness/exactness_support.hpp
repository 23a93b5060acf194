// Runs that are cut and go on, held against runs that never were: in this program, or as a user's processes.
#pragma once

#include "io/results.hpp"
#include "io/run.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace grandamp::test {

/// What of a run must not depend on how often it was cut: histories and granules by their bits, the summary but for
/// wall times and threads.
struct Outcomes {
  History history;
  Snapshot granules;
  std::string summary;
};

inline Outcomes outcomes_of(const std::filesystem::path& folder) {
  Outcomes outcomes{read_history(folder / "results.h5"), read_final_granules(folder / "results.h5"), {}};
  auto summary = nlohmann::json::parse(content_of(folder / "summary.json"));
  for (const char* key : {"wall_time", "packing_wall_time", "granule_steps_per_second", "threads"}) summary.erase(key);
  outcomes.summary = summary.dump(1);
  return outcomes;
}

inline void check_same_granules(const Snapshot& a, const Snapshot& b) {
  CHECK(a.time == b.time);
  CHECK(a.table.position == b.table.position);
  CHECK(a.table.velocity == b.table.velocity);
  CHECK(a.table.spin == b.table.spin);
  CHECK(a.table.population == b.table.population);
}

inline void check_same(const Outcomes& a, const Outcomes& b) {
  check_same_granules(a.granules, b.granules);
  CHECK(a.history.names == b.history.names);
  CHECK(a.history.columns == b.history.columns);
  CHECK(a.summary == b.summary);
}

inline RunSceneOptions threads(int count) {
  RunSceneOptions options;
  options.threads = count;
  return options;
}

/// Stops after so many steps of this part of the run.
inline RunSceneOptions stopping_after(std::int64_t steps, int count = 1) {
  RunSceneOptions options = threads(count);
  options.stop_requested = [steps]() mutable { return steps-- <= 0; };
  return options;
}

/// Names of a folder's files, sorted.
inline std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

inline const std::vector<std::string> files_of_a_run{"checkpoint.h5", "checkpoint.previous.h5", "results.h5",
                                                     "scene.toml", "summary.json"};

} // namespace grandamp::test
