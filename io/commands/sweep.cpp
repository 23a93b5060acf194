#include "io/sweep.hpp"
#include "io/case_pool.hpp"
#include "io/commands/case_progress.hpp"
#include "io/commands/commands.hpp"
#include "io/run.hpp"
#include "io/signals.hpp"

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
  require_isa(arguments.isa);
  if (arguments.index.has_value() != arguments.of.has_value())
    throw UsageError("--index and --of go together: --index I --of N runs the I-th of N parts, I from 0");
  const SceneDocument document = read_scene(arguments.scene, arguments.overrides);
  tell_notes(arguments.scene, document.notes);
  const std::filesystem::path folder = arguments.folder.empty() ? arguments.scene.stem() : arguments.folder;
  CaseProgressPrinter printer(arguments.quiet);
  SweepOptions options;
  options.vary = arguments.vary;
  options.overrides = arguments.overrides;
  options.seeds = arguments.seeds;
  options.keep_total_mass = arguments.keep == "total_mass";
  options.index = arguments.index.value_or(0);
  options.of = arguments.of.value_or(1);
  options.threads = arguments.threads;
  options.isa = arguments.isa;
  options.max_wall = arguments.max_wall;
  options.force = arguments.force;
  options.tell = [](const std::string& line) { spdlog::info("{}", line); };
  options.warning = [&printer](const std::string& line) {
    printer.clear();
    spdlog::warn("{}", line);
  };
  options.progress = [&printer](const CaseProgress& progress) { printer.show(progress); };
  options.stop_requested = SignalWatch::stop_requested;

  const SignalWatch watch;
  SweepResult result;
  try {
    result = sweep(document, arguments.scene.string(), folder, options);
  } catch (...) {
    printer.clear();
    throw;
  }
  printer.clear();
  if (arguments.json) tell(result.json);
  return tell_end(result, folder);
}

} // namespace grandamp
