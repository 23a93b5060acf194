#include "io/sweep_grid.hpp"

#include "io/run.hpp"
#include "solver/team.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp {

namespace {

/// A step of fewer granules is not worth sharing (solver/simulation.cpp).
constexpr std::size_t worth_sharing = 20'000;
constexpr int bad_scene = 2;                 // the exit status of a run of it
constexpr double standard_gravity = 9.80665; // m/s^2

std::string in_a_line(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += "; ";
    if (!problem.key.empty()) text += problem.key + (problem.value.empty() ? ": " : " = " + problem.value + ": ");
    text += problem.message;
    if (!problem.allowed.empty()) text += " (allowed: " + problem.allowed + ")";
  }
  return text;
}

} // namespace

CasePoint planned_point(const SceneDocument& base, const std::string& name, std::vector<VaryValue> values,
                        std::vector<std::string> overrides) {
  CasePoint point;
  point.values = std::move(values);
  point.overrides = std::move(overrides);
  try {
    const SceneDocument document = read_scene_text(base.text, name, point.overrides);
    const Plan plan = make_located_plan(document);
    point.granules = plan.granules;
    point.granule_mass = std::isfinite(plan.damper.granule_mass) ? plan.damper.granule_mass : 0.0;
    // A bare structure has no granules, but its steps take time, too.
    point.work = (static_cast<double>(plan.granules) + 20.0) * static_cast<double>(plan.steps);
    point.structure = plan.scene.structure;
    point.excitation = plan.scene.excitation;
    point.window = plan.window;
    const Vector3& g = plan.scene.gravity;
    const double gravity = std::hypot(g[0], g[1], g[2]);
    point.gravity = gravity > 0.0 ? gravity : standard_gravity;
  } catch (const SceneError& error) {
    point.problems = error.problems();
    point.fault = in_a_line(point.problems);
  }
  return point;
}

CaseRun run_of(const CasePoint& point, std::size_t index, int seed_index, std::uint64_t scene_seed,
               const std::filesystem::path& folder) {
  CaseRun run;
  run.point = index;
  run.seed_index = seed_index;
  run.seed = scene_seed + static_cast<std::uint64_t>(seed_index);
  run.job.scene = folder / "scene.toml";
  run.job.overrides = point.overrides;
  run.job.overrides.push_back(fmt::format("seed={}", run.seed));
  run.job.folder = folder / "runs" / fmt::format("{:03}_seed{}", index, run.seed);
  run.job.work = point.work;
  return run;
}

std::size_t largest_of(const std::vector<CasePoint>& points) {
  std::size_t granules = 0;
  for (const CasePoint& point : points) granules = std::max(granules, point.granules);
  return granules;
}

CasePoolOptions pool_options(int threads, const std::string& isa, std::size_t cases, std::size_t granules) {
  const std::size_t all = static_cast<std::size_t>(threads > 0 ? threads : usable_processors());
  CasePoolOptions pool;
  pool.isa = isa;
  pool.at_a_time = std::max<std::size_t>(std::min(all, cases), 1);
  if (granules >= worth_sharing) pool.threads_each = static_cast<int>(all / pool.at_a_time);
  return pool;
}

std::string bits_of(const std::string& isa) {
  return isa == "generic" ? isa : "avx2 or avx512";
}

void look_at_runs(std::vector<CaseRun>& runs, const std::vector<CasePoint>& points) {
  for (CaseRun& run : runs) {
    const std::string& fault = points[run.point].fault;
    run.state = fault.empty() ? state_of(run.job) : CaseState{CaseStatus::failed, bad_scene, fault};
    run.numbers = run.state.status == CaseStatus::done ? CaseNumbers(summary_of(run.job)) : CaseNumbers();
  }
}

} // namespace grandamp
