// What the runs of a study come to: time and error of every setting, with the seeds' scatter. Internal to io.
#pragma once

#include "io/study_cases.hpp"

#include <string>
#include <vector>

namespace grandamp {

/// A difference counts as told from chance beyond so many standard errors.
inline constexpr double resolved_at = 3.0;

/// An observable of one setting, held against the reference.
struct StudyDifference {
  std::string observable;
  double mean = 0.0;           ///< SI
  double relative = 0.0;       ///< mean over the reference's, less 1
  double standard_error = 0.0; ///< of `relative`; NaN with one seed alone
  bool resolved() const { return std::abs(relative) > resolved_at * standard_error; }
};

struct StudyRow {
  const StudySetting* setting = nullptr;
  int runs = 0;             ///< to the end
  std::string stopped;      ///< message of the guard that stopped one; empty: none
  double time = 0.0;        ///< s per run: the median over seeds of its share of the own settings' time, times that
  double time_spread = 0.0; ///< half the range of that share, over it
  double wall_time = 0.0;   ///< s, median
  double rate = 0.0;        ///< granule-steps per second of `time`
  double residual = 0.0;    ///< of the energy balance, mean
  double max_overlap = 0.0;
  bool audited = false;
  std::int64_t missed = 0, audited_steps = 0;
  double audited_time = 0.0;
  std::vector<StudyDifference> differences;

  const StudyDifference* find(const std::string& observable) const;
  /// The largest of the main observables' differences, and three standard errors of it. 0 without any.
  double error() const;
  double scatter() const;
};

struct StudyTable {
  std::vector<StudyRow> rows; ///< in the settings' order; those without a run to the end have no differences
  const StudyRow* own = nullptr;
  const StudyRow* reference = nullptr;
  int seeds = 0; ///< most that any setting has
};

/// An observable as it is read: "kinetic_energy" as "kinetic energy".
std::string in_words(std::string observable);

/// Observables that a setting is judged by: the structure's rms and amplitude (without one: the granules' kinetic
/// energy at the end), and all that contacts dissipate. The others are told beside them.
bool is_main(const std::string& observable);

/// Standard errors rest on the scatter of all settings together, since that of three seeds is itself a guess.
StudyTable study_table(const StudySettings& settings, const StudyCases& cases);

/// The settings that no other beats in both time and error of a contact, fastest first; models that differ from the
/// scene's are none.
std::vector<const StudyRow*> frontier(const StudyTable& table);

struct StudyAdvice {
  const StudyRow* by_observables =
      nullptr; ///< the fastest whose main observables are within the error, or not told from it
  const StudyRow* by_contact = nullptr; ///< the fastest whose contacts are
  int seeds_needed = 0;                 ///< to tell such an error from chance
};
StudyAdvice advise(const StudyTable& table, double error);

} // namespace grandamp
