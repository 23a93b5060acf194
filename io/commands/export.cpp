#include "io/commands/commands.hpp"
#include "io/results.hpp"
#include "io/run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>

namespace grandamp {
namespace {

Snapshot granules_at(const std::filesystem::path& results, double time) {
  if (auto snapshot = read_snapshot_near(results, time)) {
    spdlog::info("granules at {:.17g} s, the nearest there are", snapshot->time);
    return std::move(*snapshot);
  }
  Snapshot end = read_final_granules(results);
  if (!(std::abs(time - end.time) <= 1e-6 * end.time)) {
    throw UsageError(fmt::format("--time {}: this run took no snapshots (output.snapshot_interval), so its granules "
                                 "are known only at the end, {:.17g} s",
                                 time, end.time));
  }
  return end;
}

} // namespace

int export_command(const ExportArguments& arguments) {
  const std::filesystem::path results = arguments.folder / "results.h5";
  if (arguments.what == "history") {
    if (arguments.time) throw UsageError("--time goes with granules; a history holds all times");
    export_history(read_history(results), arguments.file);
    return exit_done;
  }
  const Snapshot granules = arguments.time ? granules_at(results, *arguments.time) : read_final_granules(results);
  export_granules(granules.table, arguments.file);
  return exit_done;
}

} // namespace grandamp
