#include "io/commands/commands.hpp"
#include "io/decay_files.hpp"
#include "io/results.hpp"
#include "io/run.hpp"
#include "io/run_response.hpp"
#include "io/scene_file.hpp"
#include "io/text_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <ctime>

namespace grandamp {
namespace {

Snapshot granules_at(const std::filesystem::path& results, double time) {
  if (auto snapshot = read_snapshot_near(results, time)) {
    spdlog::info("granules at {:.17g} s, the nearest there are", snapshot->time);
    return std::move(*snapshot);
  }
  Snapshot end = read_final_granules(results);
  if (!(std::abs(time - end.time) <= 1e-6 * end.time)) {
    throw UsageError(fmt::format("--time {}: this run took no snapshots (output.snapshot_interval), so its granules "
                                 "are known only at the end, {:.17g} s",
                                 time, end.time));
  }
  return end;
}

Scene scene_of(const ExportArguments& arguments, const std::filesystem::path& results) {
  return read_scene_text(read_stored_scene(results), (arguments.folder / "scene.toml").string()).scene;
}

void export_response(const ExportArguments& arguments, const std::filesystem::path& results) {
  if (!is_response_file(arguments.file))
    throw UsageError(fmt::format("-o {}: a response is written as .csv, .unv or .uff (universal file 58), or .svg",
                                 arguments.file.string()));
  const Scene scene = scene_of(arguments, results);
  const FrequencyResponse response = run_response(scene, read_history(results, response_columns),
                                                  {.settling = arguments.settling, .segment = arguments.segment});
  for (const std::string& note : response.notes) spdlog::warn("{}", note);
  write_response(response, scene, arguments.file, std::time(nullptr));
}

void export_decay(const ExportArguments& arguments, const std::filesystem::path& results) {
  const std::vector<VibrationCycle> cycles = read_cycles(arguments.folder / "summary.json");
  if (arguments.file.extension() != ".svg") return replace_file(arguments.file, decay_csv(cycles));
  const Scene scene = scene_of(arguments, results);
  replace_file(arguments.file, decay_svg(cycles, scene.title, scene.structure.value_or(Structure{})));
}

} // namespace

int export_command(const ExportArguments& arguments) {
  const std::filesystem::path results = arguments.folder / "results.h5";
  if (arguments.time && arguments.what != "granules")
    throw UsageError("--time goes with granules; the others are of all times");
  if ((arguments.settling || arguments.segment) && arguments.what != "response")
    throw UsageError("--settling and --segment go with response");
  if (arguments.what == "response") {
    export_response(arguments, results);
    return exit_done;
  }
  if (arguments.what == "decay") {
    export_decay(arguments, results);
    return exit_done;
  }
  if (arguments.what == "history") {
    export_history(read_history(results), arguments.file);
    return exit_done;
  }
  const Snapshot granules = arguments.time ? granules_at(results, *arguments.time) : read_final_granules(results);
  export_granules(granules.table, arguments.file);
  return exit_done;
}

} // namespace grandamp
