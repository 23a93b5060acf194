// summary.json: a run in a page. The keys are told in io/FORMAT.md.
#pragma once

#include "io/frequency_response.hpp"
#include "io/run.hpp"
#include "solver/profile.hpp"
#include "solver/simulation.hpp"

#include <string>

namespace grandamp {

/// All that a summary tells of.
struct RunRecord {
  const Plan* plan = nullptr;
  std::string isa;
  int threads = 1;
  RunStatus status = RunStatus::done;
  std::string message;            ///< why it stopped before the end
  std::int64_t steps = 0;         ///< done
  double time = 0.0;              ///< simulated, s
  double wall_time = 0.0;         ///< from t = 0, files included, s
  double packing_wall_time = 0.0; ///< before t = 0, s
  Sample initial;                 ///< at t = 0
  Sample end;                     ///< at `time`, or the last one before a guard stopped the run
  VerletStatistics verlet;
  GuardStatistics guards;
  StepReviewStatistics step_review;
  ResponseStatistics response;
  const Profile* profile = nullptr;                      ///< null: none was asked for
  const FrequencyResponse* frequency_response = nullptr; ///< null: the run gives none
  std::string no_frequency_response;                     ///< why, of a run that should
};

/// What is left of the energy balance from t = 0 to `end`, over the largest of |work in| and the kinetic, elastic and
/// structure energy at t = 0 together; if both are zero, over the largest energy at the end. Never negative.
double energy_residual(const Sample& initial, const Sample& end);

std::string summary_text(const RunRecord& record);

} // namespace grandamp
