// Many runs side by side, each a process of this program of its own. Internal to io.
//
// Processes and not threads: the HDF5 that Debian has may be used by one thread at a time alone, signals reach a whole
// process, and a run that is killed (memory, a crash) takes none of the others with it. Run, checkpoint and resume are
// those of the program: nothing of them is written twice.
#pragma once

#include "io/case_options.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace grandamp {

/// How far a run's folder is.
enum class CaseStatus { missing, started, running_elsewhere, done, failed };
const char* name(CaseStatus status);

struct CaseJob {
  std::filesystem::path scene;        ///< the base scene, self-contained
  std::vector<std::string> overrides; ///< that make it this case
  std::filesystem::path folder;
  double work = 1.0; ///< about how long it takes, in any unit
};

struct CaseState {
  CaseStatus status = CaseStatus::missing;
  int exit_status = 0; ///< of a failed case: the program's, or 128 and the signal that ended it
  std::string error;   ///< of a failed case
};

/// From the folder alone. A case that a numerical guard stopped would stop there again and counts as failed for good;
/// any other failure (memory, disk) is told by `failure.json` and tried again.
CaseState state_of(const CaseJob& job);
/// Writes what state_of then tells. Throws FileError.
void note_failure(const CaseJob& job, int exit_status, const std::string& error);
/// The text of summary.json of a case that is done or was stopped by a guard; empty: none.
std::string summary_of(const CaseJob& job);

struct CasePoolOptions {
  std::size_t at_a_time = 1;
  int threads_each = 1;
  std::string isa;
  std::function<bool()> stop_requested;
  std::function<void(const CaseProgress&)> progress;
  std::function<void(const std::string&)> warning;
};

/// Runs what is not done yet, the longest first; half-run cases go on from their checkpoints. Each case is one process,
/// whose messages go to log.txt in its folder. False if it was asked to stop: all have then written a checkpoint.
/// Throws FileError.
bool run_case_jobs(std::vector<CaseJob> jobs, const CasePoolOptions& options);

/// The whole file, put in place by one step though several programs may do so at once on a shared disk.
/// Throws FileError.
void replace_shared_file(const std::filesystem::path& path, const std::string& text);

} // namespace grandamp
