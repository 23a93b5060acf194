#include "io/optimise.hpp"

#include "io/nearest_name.hpp"
#include "io/optimise_report.hpp"
#include "io/recorder.hpp"
#include "io/run.hpp"
#include "io/summary.hpp"
#include "io/sweep_folder.hpp"
#include "io/version.hpp"
#include "kernels/dispatch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grandamp {

namespace {

namespace fs = std::filesystem;

/// What a summary of this scene has numbers for is known without running it.
std::vector<std::string> numbers_of(const Plan& plan) {
  RunRecord record;
  record.plan = &plan;
  record.steps = plan.steps;
  record.time = plan.scene.time.duration;
  record.end.time = record.time;
  return CaseNumbers(summary_text(record)).names();
}

void demand_number(const OptimiseOptions& options, const Plan& plan) {
  const std::vector<std::string> names = numbers_of(plan);
  if (std::find(names.begin(), names.end(), options.number) != names.end()) return;
  throw UsageError(fmt::format("--{} {}: no number of this scene's summary; there are: {}",
                               options.maximise ? "maximise" : "minimise", options.number, fmt::join(names, ", ")));
}

FolderIdentity identity_of(const SceneDocument& document, const OptimiseOptions& options, const std::string& isa) {
  FolderIdentity identity;
  identity.command = "optimise";
  identity.entries.emplace_back("version", version());
  identity.entries.emplace_back("bits", bits_of(isa));
  identity.entries.emplace_back("aim",
                                fmt::format("{} {}", options.maximise ? "maximise" : "minimise", options.number));
  std::string over;
  for (const FreeKey& key : parse_over(options.over, options.overrides))
    over += fmt::format("{}{} from {} to {}{}", over.empty() ? "" : "; ", key.key, key.low, key.high,
                        key.logarithmic ? " by factors" : "");
  identity.entries.emplace_back("chosen", over);
  identity.entries.emplace_back("kept", options.keep_total_mass ? "total_mass" : "nothing");
  identity.entries.emplace_back("seeds", std::to_string(options.seeds));
  identity.scene = document.text;
  return identity;
}

void write_tables(const OptimiseReport& report, const fs::path& folder) {
  const TableLock lock(folder, "optimise");
  replace_shared_file(folder / "optimise.csv", report.csv());
  replace_shared_file(folder / "optimise.json", report.json());
  report.write_pictures(folder);
}

} // namespace

OptimiseResult optimise(const SceneDocument& document, const std::string& name, const fs::path& folder,
                        const OptimiseOptions& options) {
  const Plan plan = make_located_plan(document);
  demand_number(options, plan);
  const std::string isa = options.isa.empty() ? kernels::name(kernels::best_available()) : options.isa;
  const WallClock::time_point begun = WallClock::now();
  const auto run = [&](const std::vector<CaseJob>& jobs) {
    CasePoolOptions pool = pool_options(options.threads, options.isa, jobs.size(), plan.granules);
    pool.stop_requested = [&] {
      return (options.stop_requested && options.stop_requested()) ||
             (options.max_wall > 0.0 && seconds_since(begun) >= options.max_wall);
    };
    pool.progress = options.progress;
    pool.warning = options.warning;
    return run_case_jobs(jobs, pool);
  };
  DesignSearch search(document, name, folder, options, run);
  claim_folder(folder, identity_of(document, options, isa), options.force);
  if (options.tell)
    options.tell(fmt::format("{} {} over {} key{}: at most {} designs, {} seed{} each",
                             options.maximise ? "greatest" : "least", options.number, search.keys().size(),
                             search.keys().size() == 1 ? "" : "s", options.evaluations, options.seeds,
                             options.seeds == 1 ? "" : "s"));

  OptimiseReport report;
  report.search = &search;
  report.document = &document;
  report.title = document.scene.title.empty() ? name : document.scene.title;
  report.isa = isa;
  report.number = options.number;
  report.maximise = options.maximise;
  report.keep_total_mass = options.keep_total_mass;
  report.seeds = options.seeds;
  OptimiseResult result;
  try {
    search.search();
  } catch (const SearchInterrupted&) {
    result.interrupted = true;
  }
  write_tables(report, folder);
  result.paragraph = report.paragraph();
  result.json = report.json();
  if (const Evaluation* best = search.best(); best != nullptr && !result.interrupted)
    replace_shared_file(folder / "best.toml", read_scene_text(document.text, name, best->design.overrides).text);
  return result;
}

} // namespace grandamp
