#include "io/sweep.hpp"
#include "io/commands/case_command.hpp"
#include "io/run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace grandamp {
namespace {

int tell_end(const SweepResult& result, const std::filesystem::path& folder) {
  const std::string so_far = fmt::format("{} of {} runs done", result.done, result.planned);
  if (result.interrupted) {
    spdlog::warn("interrupted, {}; the same command goes on with what is left; so far: {}", so_far,
                 (folder / "sweep.csv").string());
    return exit_interrupted;
  }
  if (result.part_failed > 0) {
    spdlog::error("{} of {} runs failed; each is told with its error in {}", result.part_failed, result.part_planned,
                  (folder / "sweep_runs.csv").string());
    return exit_guard;
  }
  if (result.part_done < result.part_planned) {
    spdlog::error("{} of {} runs are at work in another program, or were stopped; give the command again when they are "
                  "not",
                  result.part_planned - result.part_done, result.part_planned);
    return exit_guard;
  }
  if (result.done < result.planned)
    spdlog::info("{}; the table of all is written by the part that ends last, or by the command without --index",
                 so_far);
  spdlog::info("results in {}", folder.string());
  return exit_done;
}

} // namespace

int sweep_command(const SweepArguments& arguments) {
  if (arguments.index.has_value() != arguments.of.has_value())
    throw UsageError("--index and --of go together: --index I --of N runs the I-th of N parts, I from 0");
  CaseCommand command(arguments);
  SweepOptions options;
  options.vary = arguments.vary;
  options.overrides = arguments.overrides;
  options.keep_total_mass = arguments.keep == "total_mass";
  options.index = arguments.index.value_or(0);
  options.of = arguments.of.value_or(1);
  const SweepResult result = command.run(options, sweep);
  if (arguments.json) tell(result.json);
  return tell_end(result, command.folder());
}

} // namespace grandamp
