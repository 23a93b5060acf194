#include "io/sweep_damping.hpp"

#include "io/results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

using std::numbers::pi;

const std::vector<double>* column(const History& history, std::string_view name) {
  for (std::size_t k = 0; k < history.names.size(); ++k)
    if (history.names[k] == name) return &history.columns[k];
  return nullptr;
}

std::size_t row_at(const std::vector<double>& time, double when) {
  const auto after = std::lower_bound(time.begin(), time.end(), when);
  if (after == time.begin()) return 0;
  const auto k = static_cast<std::size_t>(after - time.begin());
  return k == time.size() || when - time[k - 1] <= time[k] - when ? k - 1 : k;
}

double force_of(const CasePoint& point) {
  const Excitation& excitation = point.excitation;
  return excitation.force ? *excitation.force : point.structure->stiffness * excitation.static_deflection.value_or(0.0);
}

bool is_prescribed(const CasePoint& point) {
  return point.excitation.kind == ExcitationKind::prescribed && !point.excitation.velocity;
}

} // namespace

bool is_forced_structure(const CasePoint& point) {
  return point.structure && point.excitation.kind == ExcitationKind::harmonic;
}

double closed_form_amplitude(const CasePoint& point, double added_mass, double frequency) {
  const Structure& structure = *point.structure;
  const double omega = 2.0 * pi * frequency;
  return force_of(point) /
         std::hypot(structure.stiffness - (structure.mass + added_mass) * omega * omega, structure.damping * omega);
}

void add_damping(CaseRun& run, const CasePoint& point) {
  const bool forced = is_forced_structure(point);
  if (run.state.status != CaseStatus::done || (!forced && !is_prescribed(point))) return;
  const double frequency = point.excitation.frequency, omega = 2.0 * pi * frequency;
  const double amplitude = forced ? run.numbers.at("structure.amplitude") : point.excitation.amplitude;
  if (!(amplitude > 0.0) || !(omega > 0.0)) return;
  run.numbers.put("damping.acceleration", omega * omega * amplitude / point.gravity);
  const double cycles = std::floor((point.window[1] - point.window[0]) * frequency * (1.0 + 1e-9));
  if (!run.numbers.has("energy.dissipated") || cycles < 1.0) return;

  const History history = read_history(run.job.folder / "results.h5");
  const std::vector<double>* time = column(history, "time");
  if (time == nullptr || time->empty()) return;
  const std::size_t from = row_at(*time, point.window[0]);
  const std::size_t to = row_at(*time, point.window[0] + cycles / frequency);
  const double periods = ((*time)[to] - (*time)[from]) * frequency; // rows are where they are
  if (!(periods > 0.5)) return;
  double dissipated = 0.0;
  for (const char* name : {"normal_granule", "normal_wall", "friction_granule", "friction_wall"}) {
    const std::vector<double>* lost = column(history, name);
    if (lost == nullptr) return;
    const double each = ((*lost)[to] - (*lost)[from]) / periods;
    run.numbers.put(std::string("damping.") + name, each);
    dissipated += each;
  }
  run.numbers.put("damping.dissipated", dissipated);
  const double mass = forced ? point.structure->mass : point.granule_mass;
  const double energy = 0.5 * mass * omega * omega * amplitude * amplitude;
  if (energy > 0.0) run.numbers.put("damping.loss_factor", dissipated / (2.0 * pi * energy));
  if (forced)
    run.numbers.put("damping.ratio", dissipated / (2.0 * pi * omega * amplitude * amplitude *
                                                   std::sqrt(point.structure->stiffness * point.structure->mass)));
}

} // namespace grandamp
