#include "io/run_response.hpp"

#include "io/response_files.hpp"
#include "io/run.hpp"
#include "io/text_file.hpp"
#include "io/universal_file.hpp"
#include "io/version.hpp"
#include "solver/measures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <tuple>

namespace grandamp {
namespace {

std::function<std::complex<double>(double)> oscillator(const Structure& structure, double mass) {
  return [=](double frequency) {
    const double w = 2.0 * std::numbers::pi * frequency;
    return 1.0 / std::complex<double>(structure.stiffness - mass * w * w, structure.damping * w);
  };
}

ExcitedBand drive_of(const Scene& scene) {
  if (!scene.structure)
    throw UsageError("no frequency response: the scene has no [structure] that could answer a force");
  const Excitation& e = scene.excitation;
  ExcitedBand drive{ResponseMethod::transient, 0.0, std::numeric_limits<double>::infinity(), 0.0};
  if (e.period) {
    drive.method = ResponseMethod::periodic;
    drive.period = *e.period;
  }
  switch (e.kind) {
  case ExcitationKind::none:
    throw UsageError("no frequency response: the vibration is free, without a force; `export DIR decay` tells of its "
                     "damping");
  case ExcitationKind::harmonic:
    throw UsageError("no frequency response: a harmonic force has one frequency; drive the structure by a chirp or a "
                     "random force, or step through frequencies with `grandamp sweep`");
  case ExcitationKind::prescribed:
    throw UsageError("no frequency response: the motion is prescribed, there is no force on a structure");
  case ExcitationKind::base:
    throw UsageError("no frequency response: the foundation moves at one frequency; use a table of its motion");
  case ExcitationKind::chirp:
    std::tie(drive.low, drive.high) = std::minmax(e.start_frequency, e.end_frequency);
    break;
  case ExcitationKind::random:
    if (!e.period) drive.method = ResponseMethod::welch;
    drive.low = e.band[0];
    drive.high = e.band[1];
    break;
  case ExcitationKind::impulse:
    break;
  case ExcitationKind::table:
    // A force that is over by half of the run leaves its answer to die; any other, and a motion, goes on.
    if (e.quantity != TableQuantity::force || e.times.back() > 0.5 * scene.time.duration)
      drive.method = ResponseMethod::welch;
    break;
  }
  return drive;
}

std::vector<double> column(const History& history, const char* name) {
  const auto at = std::find(history.names.begin(), history.names.end(), name);
  if (at == history.names.end()) throw FileError(fmt::format("the histories have no column {}", name));
  return history.columns[static_cast<std::size_t>(at - history.names.begin())];
}

/// Rows that are few in a half sine do not add up to its impulse: by Euler and Maclaurin, off by (pi h / t)^2 / 12.
void tell_of_coarse_pulse(const Excitation& pulse, const ResponseHistory& rows, FrequencyResponse& response) {
  const double interval = (rows.time.back() - rows.time.front()) / static_cast<double>(rows.time.size() - 1);
  const double off = std::pow(std::numbers::pi * interval / pulse.pulse_duration, 2) / 12.0;
  if (off > 0.003)
    response.notes.push_back(
        fmt::format("rows {:.3g} s apart take the pulse of {:g} s for weaker than it is, and so the "
                    "response for larger, by about {:.2g} %; shorten output.history_interval",
                    interval, pulse.pulse_duration, 100.0 * off));
}

} // namespace

LinearHost linear_host(const Scene& scene) {
  const Structure& structure = *scene.structure;
  const double loaded = structure.mass + granule_mass(scene);
  LinearHost host;
  host.bare = oscillator(structure, structure.mass);
  host.added_mass = oscillator(structure, loaded);
  host.decay_rate = 0.5 * structure.damping / loaded;
  host.bandwidth = structure.damping / (2.0 * std::numbers::pi * structure.mass);
  return host;
}

bool gives_response(const Scene& scene) {
  try {
    drive_of(scene);
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

FrequencyResponse run_response(const Scene& scene, const History& history, const ResponseSettings& settings) {
  const ResponseHistory rows{column(history, "time"), column(history, "displacement"), column(history, "velocity"),
                             column(history, "excitation")};
  FrequencyResponse response = estimate_response(rows, drive_of(scene), linear_host(scene), settings);
  if (scene.excitation.kind == ExcitationKind::impulse) tell_of_coarse_pulse(scene.excitation, rows, response);
  return response;
}

bool is_response_file(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".csv" || ending == ".unv" || ending == ".uff" || ending == ".svg";
}

void write_response(const FrequencyResponse& response, const Scene& scene, const std::filesystem::path& file,
                    std::time_t now) {
  const std::string ending = file.extension().string();
  if (ending == ".svg")
    replace_file(file, response_svg(response, scene.title, granule_mass(scene) > 0.0));
  else if (ending == ".csv")
    replace_file(file, response_csv(response));
  else
    replace_file(file, universal_file(response, {scene.title, std::string("grandamp ") + version(),
                                                 scene.structure->direction, now}));
}

} // namespace grandamp
