#include "io/commands/commands.hpp"
#include "io/results.hpp"
#include "io/run.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grandamp {

int export_command(const ExportArguments& arguments) {
  const std::filesystem::path results = arguments.folder / "results.h5";
  if (arguments.what == "history") {
    if (arguments.time) throw UsageError("--time goes with granules; a history holds all times");
    export_history(read_history(results), arguments.file);
    return exit_done;
  }
  const FinalGranules granules = read_final_granules(results);
  if (arguments.time && !(std::abs(*arguments.time - granules.time) <= 1e-6 * granules.time)) {
    throw UsageError(fmt::format("--time {}: not yet: this version takes no snapshots, so the granules are known only "
                                 "at the end, {:.17g} s",
                                 *arguments.time, granules.time));
  }
  export_granules(granules.table, arguments.file);
  return exit_done;
}

} // namespace grandamp
