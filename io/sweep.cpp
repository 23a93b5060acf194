#include "io/sweep.hpp"

#include "io/kept_mass.hpp"
#include "io/progress.hpp"
#include "io/recorder.hpp"
#include "io/run.hpp"
#include "io/sweep_damping.hpp"
#include "io/sweep_folder.hpp"
#include "io/sweep_grid.hpp"
#include "io/sweep_pictures.hpp"
#include "io/sweep_table.hpp"
#include "io/version.hpp"
#include "kernels/dispatch.hpp"
#include "solver/team.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace grandamp {

namespace {

namespace fs = std::filesystem;

std::string isa_of(const SweepOptions& options) {
  return options.isa.empty() ? kernels::name(kernels::best_available()) : options.isa;
}

SweepTable planned_table(const SceneDocument& document, const std::string& name, const fs::path& folder,
                         const SweepOptions& options) {
  SweepTable table;
  table.title = document.scene.title.empty() ? name : document.scene.title;
  table.scene_text = document.text;
  table.isa = isa_of(options);
  table.seeds = static_cast<std::size_t>(options.seeds);
  table.keep_total_mass = options.keep_total_mass;
  table.folder = folder;
  table.keys = parse_vary(options.vary, options.overrides, table.seeds);
  std::vector<std::string> keys;
  for (const VariedKey& key : table.keys) keys.push_back(key.key);
  std::optional<KeptMass> kept;
  if (options.keep_total_mass) kept.emplace(document, keys);
  for (std::vector<VaryValue>& values : grid_points(table.keys)) {
    std::vector<std::string> overrides;
    for (std::size_t i = 0; i < keys.size(); ++i) overrides.push_back(keys[i] + '=' + values[i].text);
    // After the varied values: where rounding asks for a density that differs a little, that is the one.
    if (kept)
      for (std::string& one : kept->overrides(values)) overrides.push_back(std::move(one));
    table.points.push_back(planned_point(document, name, std::move(values), std::move(overrides)));
  }
  const auto good = [](const CasePoint& point) { return point.fault.empty(); };
  if (std::none_of(table.points.begin(), table.points.end(), good)) throw SceneError(table.points.front().problems);
  for (std::size_t point = 0; point < table.points.size(); ++point)
    for (int seed = 0; seed < options.seeds; ++seed)
      table.runs.push_back(run_of(table.points[point], point, seed, document.scene.seed, folder));
  return table;
}

FolderIdentity identity_of(const SweepTable& table, const SweepOptions& options) {
  FolderIdentity identity;
  identity.command = "sweep";
  identity.entries.emplace_back("version", version());
  identity.entries.emplace_back("bits", bits_of(table.isa));
  std::string varied;
  for (const VariedKey& key : table.keys) {
    std::vector<std::string> values;
    for (const VaryValue& value : key.values) values.push_back(value.text);
    varied += fmt::format("{}{} = {}", varied.empty() ? "" : "; ", key.key, fmt::join(values, ", "));
  }
  identity.entries.emplace_back("varied", varied);
  identity.entries.emplace_back("kept", options.keep_total_mass ? "total_mass" : "nothing");
  identity.scene = table.scene_text;
  return identity;
}

/// Every of-th run of the longest-first order, from the index-th on: parts of about the same length.
std::vector<std::size_t> part_of(const SweepTable& table, const SweepOptions& options) {
  std::vector<std::size_t> order(table.runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&table](std::size_t a, std::size_t b) {
    return table.points[table.runs[a].point].work > table.points[table.runs[b].point].work;
  });
  std::vector<std::size_t> part;
  for (std::size_t k = static_cast<std::size_t>(options.index); k < order.size();
       k += static_cast<std::size_t>(options.of))
    part.push_back(order[k]);
  return part;
}

void tell_plan(const SweepTable& table, const SweepOptions& options, const std::vector<CaseJob>& jobs, int at_a_time) {
  if (!options.tell) return;
  std::size_t left = 0;
  for (const CaseJob& job : jobs) left += state_of(job).status == CaseStatus::done ? 0 : 1;
  std::string line = fmt::format("{} points, {} seed{}: {} runs", table.points.size(), table.seeds,
                                 table.seeds == 1 ? "" : "s", table.runs.size());
  if (options.of > 1) line += fmt::format("; part {} of {} (from 0): {}", options.index, options.of, jobs.size());
  if (left < jobs.size()) line += fmt::format(", {} done before", jobs.size() - left);
  options.tell(line + fmt::format("; {} at a time", at_a_time));
  const bool placed_by_chance =
      std::any_of(table.points.begin(), table.points.end(), [](const CasePoint& point) { return point.granules > 0; });
  if (table.seeds > 1 && !placed_by_chance) options.tell("no granules anywhere: all seeds of a point give the same");
}

/// Everything in the folder is read and told; whoever comes last tells of all.
void write_tables(SweepTable& table) {
  const TableLock lock(table.folder, "sweep");
  look_at_runs(table.runs, table.points);
  if (is_damping(table))
    for (CaseRun& run : table.runs) add_damping(run, table.points[run.point]);
  table.sum_up();
  write_sweep_pictures(table);
  replace_shared_file(table.folder / "sweep.csv", table.csv());
  replace_shared_file(table.folder / "sweep_runs.csv", table.runs_csv());
  replace_shared_file(table.folder / "sweep.json", table.json());
  table.write_hdf5();
}

} // namespace

SweepResult sweep(const SceneDocument& document, const std::string& name, const fs::path& folder,
                  const SweepOptions& options) {
  if (options.index < 0 || options.of < 1 || options.index >= options.of)
    throw UsageError(fmt::format("--index {} --of {}: no such part; allowed: --index from 0 to one less than --of",
                                 options.index, options.of));
  if (options.force && options.of > 1)
    throw UsageError("--force and --of: one part would remove what another has done; remove the folder first");
  SweepTable table = planned_table(document, name, folder, options);
  claim_folder(folder, identity_of(table, options), options.force);

  const std::vector<std::size_t> part = part_of(table, options);
  std::vector<CaseJob> jobs;
  for (const std::size_t k : part)
    if (table.points[table.runs[k].point].fault.empty()) jobs.push_back(table.runs[k].job);
  const CasePoolOptions pool = pool_options(options.threads, options.isa, jobs.size(), largest_of(table.points));
  tell_plan(table, options, jobs, static_cast<int>(pool.at_a_time));
  CasePoolOptions conducted = pool;
  const WallClock::time_point begun = WallClock::now();
  conducted.stop_requested = [&] {
    return (options.stop_requested && options.stop_requested()) ||
           (options.max_wall > 0.0 && seconds_since(begun) >= options.max_wall);
  };
  conducted.progress = options.progress;
  conducted.warning = options.warning;

  SweepResult result;
  result.interrupted = !run_case_jobs(jobs, conducted);
  write_tables(table);
  result.planned = table.runs.size();
  result.done = table.count(CaseStatus::done);
  result.failed = table.count(CaseStatus::failed);
  result.part_planned = part.size();
  for (const std::size_t k : part) {
    result.part_done += table.runs[k].state.status == CaseStatus::done ? 1 : 0;
    result.part_failed += table.runs[k].state.status == CaseStatus::failed ? 1 : 0;
  }
  result.json = table.json();
  return result;
}

} // namespace grandamp
