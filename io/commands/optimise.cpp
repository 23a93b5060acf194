#include "io/optimise.hpp"
#include "io/commands/case_command.hpp"
#include "io/run.hpp"

#include <spdlog/spdlog.h>

namespace grandamp {

int optimise_command(const OptimiseArguments& arguments) {
  if (arguments.minimise.empty() == arguments.maximise.empty())
    throw UsageError("one of --minimise and --maximise is needed: --minimise structure.rms_displacement");
  CaseCommand command(arguments);
  OptimiseOptions options;
  options.maximise = !arguments.maximise.empty();
  options.number = options.maximise ? arguments.maximise : arguments.minimise;
  options.over = arguments.over;
  options.overrides = arguments.overrides;
  options.keep_total_mass = arguments.keep == "total_mass";
  options.evaluations = arguments.evaluations;
  const OptimiseResult result = command.run(options, optimise);
  const std::filesystem::path& folder = command.folder();
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
