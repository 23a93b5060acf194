#include "io/run.hpp"
#include "io/commands/commands.hpp"
#include "io/progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>

namespace grandamp {
namespace {

// A signal handler can reach nothing else.
volatile std::sig_atomic_t interrupted = 0;

/// While it lives an interrupt asks the run to stop at the next step; a second one ends the program at once.
class InterruptWatch {
public:
  InterruptWatch() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &old_interrupt_);
    sigaction(SIGTERM, &action, &old_terminate_);
  }
  ~InterruptWatch() {
    sigaction(SIGINT, &old_interrupt_, nullptr);
    sigaction(SIGTERM, &old_terminate_, nullptr);
  }
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

private:
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
};

std::string closing_line(const RunResult& result, double wall_time, const std::filesystem::path& folder) {
  std::string line =
      fmt::format("{:.6g} s in {} steps, {} of wall time", result.time, result.steps, readable_seconds(wall_time));
  if (result.response) {
    line += fmt::format("; amplitude {:.4g} mm, rms {:.4g} mm, {}", 1e3 * result.response->amplitude,
                        1e3 * result.response->rms_displacement, result.response->steady ? "steady" : "not steady");
  }
  return line + "; results in " + folder.string();
}

int status_of(const RunResult& result) {
  switch (result.status) {
  case RunStatus::done:
    return exit_done;
  case RunStatus::interrupted:
    return exit_interrupted;
  case RunStatus::stopped_by_guard:
    return exit_guard;
  }
  return exit_done;
}

} // namespace

int run_command(const RunArguments& arguments) {
  require_isa(arguments.isa);
  const SceneDocument document = read_scene(arguments.scene, arguments.overrides);

  const std::filesystem::path folder = arguments.folder.empty() ? arguments.scene.stem() : arguments.folder;
  ProgressPrinter printer(arguments.quiet ? ProgressPrinter::Style::none : ProgressPrinter::style_here());
  double wall_time = 0.0;
  RunSceneOptions options;
  options.threads = arguments.threads;
  options.isa = arguments.isa;
  options.force = arguments.force;
  options.profile = arguments.profile;
  options.notes = [&](const std::vector<Problem>& notes) { tell_notes(arguments.scene, notes); };
  options.stop_requested = [] { return interrupted != 0; };
  options.progress = [&](const RunProgress& progress) {
    wall_time = progress.wall_time;
    printer.show(progress);
  };
  options.warning = [&](const std::string& warning) {
    printer.clear();
    spdlog::warn("{}", warning);
  };

  const InterruptWatch watch;
  RunResult result;
  try {
    result = run_scene(document, folder, options);
  } catch (...) {
    printer.clear();
    throw;
  }
  printer.clear();
  if (result.status == RunStatus::interrupted) {
    spdlog::warn("{}", result.message);
  } else if (result.status == RunStatus::stopped_by_guard) {
    spdlog::error("{}", result.message);
  }
  if (!result.summary.empty()) spdlog::info("{}", closing_line(result, wall_time, folder));
  if (arguments.json) fmt::print("{}", result.summary);
  return status_of(result);
}

} // namespace grandamp
