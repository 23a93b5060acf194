#include "io/decay_files.hpp"

#include "io/run.hpp"
#include "io/svg_grid.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <limits>

namespace grandamp {

std::string decay_csv(const std::vector<VibrationCycle>& cycles) {
  std::string text = "cycle,start,amplitude,peak_kinetic_energy,specific_damping_capacity,damping_ratio\n";
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    const VibrationCycle& cycle = cycles[k];
    fmt::format_to(std::back_inserter(text), "{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", k + 1, cycle.start,
                   cycle.amplitude, cycle.peak_kinetic_energy, cycle.specific_damping_capacity, cycle.damping_ratio);
  }
  return text;
}

std::string decay_svg(const std::vector<VibrationCycle>& cycles, const std::string& title, const Structure& bare) {
  const double critical = 2.0 * std::sqrt(bare.mass * bare.stiffness);
  Plot damping;
  damping.title = title;
  damping.x = {.name = "amplitude of the cycle, mm", .logarithmic = true};
  damping.y = {.name = "damping ratio"};
  PlotSeries measured{.name = "by cycle", .line = true}, own{.name = "the structure's own", .colour = "#9e9e9e"};
  own.line = true;
  own.dots = false;
  Plot decay;
  decay.title = "Amplitude of the cycles";
  decay.x = {.name = "time, s"};
  decay.y = {.name = "amplitude, mm", .logarithmic = true};
  PlotSeries amplitude{.line = true};
  for (const VibrationCycle& cycle : cycles) {
    measured.points.push_back({.x = 1e3 * cycle.amplitude, .y = cycle.damping_ratio});
    own.points.push_back({.x = 1e3 * cycle.amplitude, .y = bare.damping / critical});
    amplitude.points.push_back({.x = cycle.start, .y = 1e3 * cycle.amplitude});
  }
  damping.series.push_back(measured);
  if (critical > 0.0) damping.series.push_back(own);
  decay.series.push_back(amplitude);
  return grid_svg({damping, decay}, 2);
}

std::vector<VibrationCycle> read_cycles(const std::filesystem::path& summary) {
  std::ifstream file(summary);
  if (!file) throw FileError(summary.string() + ": cannot be read; the run has not come to its end");
  const nlohmann::json told = nlohmann::json::parse(file, nullptr, false);
  if (!told.is_object()) throw FileError(summary.string() + ": is damaged: no JSON object");
  const nlohmann::json structure = told.value("structure", nlohmann::json());
  if (!structure.is_object() || !structure.contains("cycles"))
    throw UsageError("no decay: the run is no free vibration of a [structure] (it has none, or an [excitation])");
  const auto number = [&summary](const nlohmann::json& cycle, const char* key) {
    const auto value = cycle.is_object() ? cycle.find(key) : cycle.end();
    if (value == cycle.end() || !(value->is_number() || value->is_null()))
      throw FileError(fmt::format("{}: is damaged: a cycle without {}", summary.string(), key));
    return value->is_null() ? std::numeric_limits<double>::quiet_NaN() : value->get<double>();
  };
  if (!structure["cycles"].is_array()) throw FileError(summary.string() + ": is damaged: its cycles are no list");
  std::vector<VibrationCycle> cycles;
  for (const nlohmann::json& told_of : structure["cycles"]) {
    VibrationCycle cycle;
    cycle.start = number(told_of, "start");
    cycle.amplitude = number(told_of, "amplitude");
    cycle.peak_kinetic_energy = number(told_of, "peak_kinetic_energy");
    cycle.specific_damping_capacity = number(told_of, "specific_damping_capacity");
    cycle.damping_ratio = number(told_of, "damping_ratio");
    cycles.push_back(cycle);
  }
  if (cycles.empty())
    throw UsageError("no decay: the run holds no whole cycle (two swings, and the next one to compare); lengthen "
                     "time.duration");
  return cycles;
}

} // namespace grandamp
