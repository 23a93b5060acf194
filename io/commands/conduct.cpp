#include "io/commands/conduct.hpp"

#include "io/commands/commands.hpp"
#include "io/progress.hpp"
#include "io/signals.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>

namespace grandamp {
namespace {

std::string closing_line(const RunResult& result, double wall_time, const std::filesystem::path& folder) {
  std::string line =
      fmt::format("{:.6g} s in {} steps, {} of wall time", result.time, result.steps, readable_seconds(wall_time));
  if (result.response && !std::isnan(result.response->amplitude)) {
    line += fmt::format("; amplitude {:.4g} mm, rms {:.4g} mm, {}", 1e3 * result.response->amplitude,
                        1e3 * result.response->rms_displacement, result.response->steady ? "steady" : "not steady");
  }
  return line + "; results in " + folder.string();
}

int tell_end(const RunResult& result) {
  switch (result.status) {
  case RunStatus::done:
    return exit_done;
  case RunStatus::done_before:
    spdlog::info("{}", result.message);
    return exit_done;
  case RunStatus::interrupted:
    spdlog::warn("{}", result.message);
    return exit_interrupted;
  case RunStatus::stopped_by_guard:
    spdlog::error("{}", result.message);
    return exit_guard;
  }
  return exit_done;
}

} // namespace

int conduct(const std::filesystem::path& scene, const std::filesystem::path& folder, RunSceneOptions options,
            bool quiet, bool json, const std::function<RunResult(const RunSceneOptions&)>& work) {
  ProgressPrinter printer(quiet ? ProgressPrinter::Style::none : ProgressPrinter::style_here());
  double wall_time = 0.0;
  options.notes = [&](const std::vector<Problem>& notes) { tell_notes(scene, notes); };
  options.stop_requested = SignalWatch::stop_requested;
  options.checkpoint_requested = SignalWatch::take_checkpoint_request;
  options.progress = [&](const RunProgress& progress) {
    wall_time = progress.wall_time;
    printer.show(progress);
  };
  options.warning = [&](const std::string& warning) {
    printer.clear();
    spdlog::warn("{}", warning);
  };

  const SignalWatch watch;
  RunResult result;
  try {
    result = work(options);
  } catch (...) {
    printer.clear();
    throw;
  }
  printer.clear();
  const int status = tell_end(result);
  if (!result.summary.empty() && result.status != RunStatus::done_before)
    spdlog::info("{}", closing_line(result, wall_time, folder));
  if (json) tell(result.summary);
  return status;
}

} // namespace grandamp
