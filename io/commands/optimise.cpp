#include "io/optimise.hpp"
#include "io/case_pool.hpp"
#include "io/commands/case_progress.hpp"
#include "io/commands/commands.hpp"
#include "io/run.hpp"
#include "io/signals.hpp"

#include <spdlog/spdlog.h>

namespace grandamp {

int optimise_command(const OptimiseArguments& arguments) {
  require_isa(arguments.isa);
  if (arguments.minimise.empty() == arguments.maximise.empty())
    throw UsageError("one of --minimise and --maximise is needed: --minimise structure.rms_displacement");
  const SceneDocument document = read_scene(arguments.scene, arguments.overrides);
  tell_notes(arguments.scene, document.notes);
  const std::filesystem::path folder = arguments.folder.empty() ? arguments.scene.stem() : arguments.folder;
  CaseProgressPrinter printer(arguments.quiet);
  OptimiseOptions options;
  options.maximise = !arguments.maximise.empty();
  options.number = options.maximise ? arguments.maximise : arguments.minimise;
  options.over = arguments.over;
  options.overrides = arguments.overrides;
  options.keep_total_mass = arguments.keep == "total_mass";
  options.seeds = arguments.seeds;
  options.evaluations = arguments.evaluations;
  options.threads = arguments.threads;
  options.isa = arguments.isa;
  options.max_wall = arguments.max_wall;
  options.force = arguments.force;
  options.tell = [&printer](const std::string& line) {
    printer.clear();
    spdlog::info("{}", line);
  };
  options.warning = [&printer](const std::string& line) {
    printer.clear();
    spdlog::warn("{}", line);
  };
  options.progress = [&printer](const CaseProgress& progress) { printer.show(progress); };
  options.stop_requested = SignalWatch::stop_requested;

  const SignalWatch watch;
  OptimiseResult result;
  try {
    result = optimise(document, arguments.scene.string(), folder, options);
  } catch (...) {
    printer.clear();
    throw;
  }
  printer.clear();
  if (arguments.json)
    tell(result.json);
  else if (!result.paragraph.empty() && !arguments.quiet)
    tell(result.paragraph + "\n");
  if (result.interrupted) {
    spdlog::warn("interrupted; the same command goes on with what is left; so far: {}",
                 (folder / "optimise.csv").string());
    return exit_interrupted;
  }
  spdlog::info("results in {}; the best design: {}", folder.string(), (folder / "best.toml").string());
  return exit_done;
}

} // namespace grandamp
