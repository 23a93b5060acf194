// The points of a sweep, each planned, and its runs. Internal to io.
#pragma once

#include "io/case_numbers.hpp"
#include "io/case_pool.hpp"
#include "io/scene_file.hpp"
#include "io/vary.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// One grid point, or one design: what it overrides, and what its scene comes to.
struct CasePoint {
  std::vector<VaryValue> values;      ///< of the varied keys
  std::vector<std::string> overrides; ///< KEY=VALUE without the seed
  std::string fault;                  ///< why this is no scene that can be run; empty: it is one
  std::vector<Problem> problems;      ///< the same, as they were found
  std::size_t granules = 0;
  double granule_mass = 0.0; ///< total, kg
  double work = 1.0;         ///< granules times steps
  std::optional<Structure> structure;
  Excitation excitation;
  std::array<double, 2> window{0.0, 0.0}; ///< s
  double gravity = 0.0;                   ///< m/s^2; the standard one where the scene has none
};

/// Plans the scene under the overrides; a scene that cannot be run is told by `fault`.
CasePoint planned_point(const SceneDocument& base, const std::string& name, std::vector<VaryValue> values,
                        std::vector<std::string> overrides);

struct CaseRun {
  std::size_t point = 0;
  int seed_index = 0;
  std::uint64_t seed = 0;
  CaseJob job;
  CaseState state;
  CaseNumbers numbers; ///< of a run that is done
};

/// The run of a point from the scene's seed + `seed_index`, in folder/runs/NAME.
CaseRun run_of(const CasePoint& point, std::size_t index, int seed_index, std::uint64_t scene_seed,
               const std::filesystem::path& folder);

/// Granules of the largest point.
std::size_t largest_of(const std::vector<CasePoint>& points);

/// How many cases go side by side, and on how many threads each, of `threads` in all (0: what the process may use): a
/// case of its own on every core; only where there are fewer cases than cores and they are large do they share.
CasePoolOptions pool_options(int threads, const std::string& isa, std::size_t cases, std::size_t granules);

/// "avx2 or avx512", whose results have the same bits, or "generic".
std::string bits_of(const std::string& isa);

/// Reads what the folders of the runs tell; runs of points that are no scenes count as failed.
void look_at_runs(std::vector<CaseRun>& runs, const std::vector<CasePoint>& points);

} // namespace grandamp
