#include "io/commands/case_command.hpp"

#include "io/run.hpp"

#include <spdlog/spdlog.h>

namespace grandamp {

CaseCommand::CaseCommand(const CaseArguments& arguments) : arguments_(arguments), printer_(arguments.quiet) {
  require_isa(arguments.isa);
  document_ = read_scene(arguments.scene, arguments.overrides);
  tell_notes(arguments.scene, document_.notes);
  folder_ = arguments.folder.empty() ? arguments.scene.stem() : arguments.folder;
}

void CaseCommand::fill(CaseOptions& options) {
  options.seeds = arguments_.seeds;
  options.threads = arguments_.threads;
  options.isa = arguments_.isa;
  options.max_wall = arguments_.max_wall;
  options.force = arguments_.force;
  options.tell = [this](const std::string& line) {
    printer_.clear();
    spdlog::info("{}", line);
  };
  options.warning = [this](const std::string& line) {
    printer_.clear();
    spdlog::warn("{}", line);
  };
  options.progress = [this](const CaseProgress& progress) { printer_.show(progress); };
  options.stop_requested = SignalWatch::stop_requested;
}

} // namespace grandamp
