// The runs of a study: one setting from one seed each, kept in a file each. Internal to io.
#pragma once

#include "io/study.hpp"
#include "io/study_settings.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// What one run told.
struct StudyCase {
  std::string setting;
  int seed = 0;        ///< 0 the first
  bool audit = false;  ///< only counts missed contacts
  std::string stopped; ///< by a guard: its message; empty: ran to its end
  std::int64_t steps = 0;
  double wall_time = 0.0;      ///< of the steps, s
  double processor_time = 0.0; ///< of the steps, s; 0 with several threads
  double rate = 0.0;           ///< granule-steps per second of `time()`
  double residual = 0.0;       ///< of the energy balance, over the work put in
  double max_overlap = 0.0;    ///< over the smaller radius
  std::int64_t audited = 0, missed = 0;
  double audited_time = 0.0; ///< simulated, s
  std::map<std::string, double> observables;

  /// Processor time where one thread worked: what a busy machine leaves alone; else wall time, s.
  double time() const { return processor_time > 0.0 ? processor_time : wall_time; }
};

struct StudyCases {
  std::vector<StudyCase> done;
  std::size_t planned = 0;
  bool interrupted = false;
};

/// Runs every setting from every seed, unless its file is there already: all settings of a seed in turn, beginning with
/// another one for each seed, so that whatever else the machine does falls on all alike. Throws FileError, GuardError
/// (no packing), SceneError.
StudyCases run_cases(const SceneDocument& document, const std::string& name, const StudySettings& settings,
                     const std::filesystem::path& folder, const StudyOptions& options);

inline constexpr double study_audit_seconds = 5.0; ///< at most, about, of a run that counts missed contacts

/// How many threads run cases side by side, and how many each case has.
struct StudyThreads {
  int cases = 1;
  int each = 1;
};
StudyThreads study_threads(std::size_t granules, int asked);

} // namespace grandamp
