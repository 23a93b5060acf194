#include "io/summary.hpp"

#include "io/json.hpp"
#include "io/version.hpp"
#include "solver/several_modes.hpp"

#include <algorithm>
#include <cmath>

namespace grandamp {
namespace {

double total(const StoredEnergy& stored) {
  return stored.kinetic + stored.gravitational + stored.elastic + stored.structure;
}

double losses(const Ledger& ledger) {
  return ledger.structural_damping + ledger.normal_granule + ledger.normal_wall + ledger.friction_granule +
         ledger.friction_wall;
}

Json stored_json(const StoredEnergy& stored) {
  return {{"kinetic", stored.kinetic},
          {"gravitational", stored.gravitational},
          {"elastic", stored.elastic},
          {"structure", stored.structure}};
}

/// Before the window there is nothing to tell of.
Json structure_json(const RunRecord& record) {
  const ResponseStatistics& response = record.response;
  const bool reached = record.time > record.plan->window[0];
  const auto known = [reached](double value) { return reached ? Json(value) : Json(nullptr); };
  Json structure{{"rms_displacement", known(response.rms_displacement)},
                 {"peak_displacement", known(response.peak_displacement)},
                 {"amplitude", known(response.amplitude)},
                 {"steady", response.steady},
                 {"window", record.plan->window}};
  if (has_several_modes(record.plan->scene)) {
    const ModalNumbers modal = modal_numbers(record.plan->scene.structure->modes);
    structure["direction"] = record.plan->scene.structure->direction;
    Json& modes = structure["modes"] = Json::array();
    for (std::size_t k = 0; k < modal.frequency.size(); ++k)
      modes.push_back({{"frequency", modal.frequency[k]}, {"damping_ratio", modal.damping_ratio[k]}});
    return structure;
  }
  if (record.plan->scene.excitation.kind != ExcitationKind::none) return structure;
  Json& cycles = structure["cycles"] = Json::array();
  for (const VibrationCycle& cycle : response.cycles)
    cycles.push_back({{"start", cycle.start},
                      {"amplitude", cycle.amplitude},
                      {"peak_kinetic_energy", cycle.peak_kinetic_energy},
                      {"specific_damping_capacity", cycle.specific_damping_capacity},
                      {"damping_ratio", cycle.damping_ratio}});
  return structure;
}

Json frequency_response_json(const FrequencyResponse& response) {
  const Spectra& spectra = response.spectra;
  Json told{{"method", name(response.method)},
            {"band", {spectra.frequency.front(), spectra.frequency.back()}},
            {"resolution", spectra.resolution},
            {"settling", response.settling},
            {"segment", response.segment},
            {"averages", spectra.segments},
            {"peak_frequency", spectra.frequency[response.peak]},
            {"peak_magnitude", std::abs(response.response[response.peak])},
            {"mean_coherence", json_number(response.mean_coherence())},
            {"random_error", json_number(response.mean_random_error())},
            {"bias", response.bias}};
  if (response.fit.found)
    told["fit"] = {{"natural_frequency", response.fit.natural_frequency},
                   {"damping_ratio", response.fit.damping_ratio},
                   {"peak_frequency", response.fit.peak_frequency},
                   {"peak_magnitude", response.fit.peak_magnitude},
                   {"mass", response.fit.mass},
                   {"stiffness", response.fit.stiffness},
                   {"damping", response.fit.damping},
                   {"lines", response.fit.lines}};
  told["notes"] = response.notes;
  return told;
}

Json energy_json(const RunRecord& record) {
  const Ledger& ledger = record.end.ledger;
  Json energy{{"initial", stored_json(record.initial.stored)}};
  energy.update(stored_json(record.end.stored));
  energy["work_in"] = ledger.work_in;
  energy["structural_damping"] = ledger.structural_damping;
  energy["normal_granule"] = ledger.normal_granule;
  energy["normal_wall"] = ledger.normal_wall;
  energy["friction_granule"] = ledger.friction_granule;
  energy["friction_wall"] = ledger.friction_wall;
  energy["residual"] = energy_residual(record.initial, record.end);
  if (record.end.time != record.time) energy["time"] = record.end.time;
  return energy;
}

const char* name(RunStatus status) {
  switch (status) {
  case RunStatus::done:
  case RunStatus::done_before:
    return "done";
  case RunStatus::interrupted:
    return "interrupted";
  case RunStatus::stopped_by_guard:
    return "stopped by a guard";
  }
  return "";
}

Json step_choice_json(const StepChoice& choice) {
  return {{"asked", choice.asked},
          {"error", choice.error},
          {"contact", choice.contact},
          {"steps_per_contact", choice.steps_per_contact},
          {"integrator", choice.integrator == Integrator::verlet ? "verlet" : "leapfrog"},
          {"reason", choice.reason()}};
}

/// The duration as the scene says it where the steps add up to it but for rounding.
double simulated(const RunRecord& record) {
  const double asked = record.plan->scene.time.duration;
  return std::abs(record.time - asked) <= 1e-9 * asked ? asked : record.time;
}

} // namespace

double energy_residual(const Sample& initial, const Sample& end) {
  const double left = total(initial.stored) + end.ledger.work_in - total(end.stored) - losses(end.ledger);
  double scale = std::max(std::abs(end.ledger.work_in),
                          initial.stored.kinetic + initial.stored.elastic + initial.stored.structure);
  if (scale == 0.0) { // as in a fall from rest
    scale = std::max({end.stored.kinetic, std::abs(end.stored.gravitational - initial.stored.gravitational),
                      end.stored.elastic, end.stored.structure, losses(end.ledger)});
  }
  return scale == 0.0 ? 0.0 : std::abs(left) / scale;
}

std::string summary_text(const RunRecord& record) {
  const Plan& plan = *record.plan;
  const double granule_steps = static_cast<double>(plan.granules) * static_cast<double>(record.steps);
  Json summary;
  summary["title"] = plan.scene.title;
  summary["version"] = version();
  summary["status"] = name(record.status);
  if (record.status != RunStatus::done) {
    summary["message"] = record.message;
    summary["planned_duration"] = plan.scene.time.duration;
    summary["planned_steps"] = plan.steps;
  }
  summary["granules"] = plan.granules;
  summary["duration"] = simulated(record);
  summary["time_step"] = plan.time_step;
  summary["steps"] = record.steps;
  if (plan.scene.time.adaptive)
    summary["step_review"] = {{"refined_steps", record.step_review.refined}, {"parts", record.step_review.parts}};
  if (plan.step_choice) summary["step_choice"] = step_choice_json(*plan.step_choice);
  summary["contact_duration"] = plan.contact_duration;
  summary["impact_speed"] = plan.impact_speed;
  summary["wall_time"] = record.wall_time;
  summary["packing_wall_time"] = record.packing_wall_time;
  summary["granule_steps_per_second"] = record.wall_time > 0.0 ? granule_steps / record.wall_time : 0.0;
  summary["threads"] = record.threads;
  summary["isa"] = record.isa;
  summary["precision"] = plan.scene.time.precision == Precision::mixed ? "mixed" : "double";
  summary["effects"] = plan.effects;
  summary["effects_left_out"] = plan.effects_left_out;
  if (plan.scene.structure) summary["structure"] = structure_json(record);
  if (record.frequency_response != nullptr)
    summary["response"] = frequency_response_json(*record.frequency_response);
  else if (!record.no_frequency_response.empty())
    summary["response"] = {{"message", record.no_frequency_response}};
  if (plan.scene.output.energy) summary["energy"] = energy_json(record);
  summary["verlet"] = {{"builds", record.verlet.builds},
                       {"mean_interval", record.verlet.mean_interval},
                       {"candidates_per_granule", record.verlet.candidates_per_granule},
                       {"contacts_per_granule", record.verlet.contacts_per_granule},
                       {"skin", record.verlet.skin},
                       {"audited", record.verlet.audited},
                       {"missed", record.verlet.missed},
                       {"missed_pair_steps", record.verlet.missed_pair_steps}};
  summary["guards"] = {{"max_overlap", record.guards.max_overlap},
                       {"max_speed", record.guards.max_speed},
                       {"max_closing_speed", record.guards.max_closing},
                       {"escaped", record.guards.escaped}};
  if (record.profile != nullptr) {
    const auto seconds = record.profile->totals();
    for (std::size_t phase = 0; phase < seconds.size(); ++phase)
      summary["profile"][phase_names[phase]] = seconds[phase];
  }
  // Text that is not UTF-8 (a title) must not cost the run its summary.
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace grandamp
