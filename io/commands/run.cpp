#include "io/run.hpp"
#include "io/commands/commands.hpp"
#include "io/commands/conduct.hpp"

namespace grandamp {

int run_command(const RunArguments& arguments) {
  require_isa(arguments.isa);
  const SceneDocument document = read_scene(arguments.scene, arguments.overrides);
  const std::filesystem::path folder = arguments.folder.empty() ? arguments.scene.stem() : arguments.folder;
  RunSceneOptions options;
  options.threads = arguments.threads;
  options.isa = arguments.isa;
  options.max_wall = arguments.max_wall;
  options.force = arguments.force;
  options.profile = arguments.profile;
  return conduct(arguments.scene, folder, std::move(options), arguments.quiet, arguments.json,
                 [&](const RunSceneOptions& conducted) { return run_scene(document, folder, conducted); });
}

} // namespace grandamp
