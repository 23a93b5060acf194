#include "io/commands/commands.hpp"
#include "io/commands/conduct.hpp"
#include "io/run.hpp"

namespace grandamp {

int resume_command(const ResumeArguments& arguments) {
  require_isa(arguments.isa);
  RunSceneOptions options;
  options.threads = arguments.threads;
  options.isa = arguments.isa;
  options.max_wall = arguments.max_wall;
  options.profile = arguments.profile;
  return conduct(
      arguments.folder / "scene.toml", arguments.folder, std::move(options), arguments.quiet, arguments.json,
      [&](const RunSceneOptions& conducted) { return resume_run(arguments.folder, arguments.overrides, conducted); });
}

} // namespace grandamp
