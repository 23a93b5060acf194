// The commands of the program: each takes what was typed and returns the exit status.
#pragma once

#include "solver/errors.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// The exit statuses of the program.
enum ExitStatus { exit_done = 0, exit_usage = 2, exit_guard = 3, exit_file = 4, exit_interrupted = 130 };

struct RunArguments {
  std::filesystem::path scene;
  std::filesystem::path folder;       ///< empty: the scene's stem
  std::vector<std::string> overrides; ///< KEY=VALUE
  int threads = 0;                    ///< 0: chosen
  std::string isa;                    ///< empty: the best
  bool force = false;
  double max_wall = 0.0; ///< s; 0: no end
  bool profile = false;
  bool quiet = false;
  bool json = false;
};

struct ResumeArguments {
  std::filesystem::path folder;
  std::vector<std::string> overrides;
  int threads = 0;
  std::string isa; ///< empty: that of before, or one with its bits
  double max_wall = 0.0;
  bool profile = false;
  bool quiet = false;
  bool json = false;
};

struct CheckArguments {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
  int threads = 0;
  std::string isa;
  bool quiet = false;
  bool json = false;
};

/// Of a command that makes many runs.
struct CaseArguments {
  std::filesystem::path scene;
  std::filesystem::path folder;       ///< empty: the scene's stem
  std::vector<std::string> overrides; ///< KEY=VALUE
  int seeds = 1;
  int threads = 0; ///< 0: what the process may use
  std::string isa;
  double max_wall = 0.0; ///< s; 0: no end
  bool force = false;
  bool quiet = false;
  bool json = false;
};

struct StudyArguments : CaseArguments {
  StudyArguments() { seeds = 3; }
  std::string error = "1%";      ///< that settings are recommended for
  std::vector<std::string> vary; ///< groups of settings; empty: all
};

struct SweepArguments : CaseArguments {
  std::vector<std::string> vary; ///< KEY=START:STOP:COUNT or KEY=a,b,c
  std::string keep;              ///< "total_mass" or empty
  std::optional<int> index, of;
};

struct OptimiseArguments : CaseArguments {
  OptimiseArguments() { seeds = 3; }
  std::string minimise, maximise; ///< a number of the summary; one of the two
  std::vector<std::string> over;  ///< KEY=A:B
  std::string keep;               ///< "total_mass" or empty
  int evaluations = 20;
};

struct ExportArguments {
  std::filesystem::path folder;
  std::string what;               ///< "history", "granules", "response" or "decay"
  std::optional<double> time;     ///< of granules, s
  std::optional<double> settling; ///< of a response, s
  std::optional<double> segment;  ///< of a response, s
  std::filesystem::path file;
};

struct ReportArguments {
  std::filesystem::path folder;
};

struct InspectArguments {
  std::filesystem::path file;
};

int run_command(const RunArguments& arguments);
int resume_command(const ResumeArguments& arguments);
int check_command(const CheckArguments& arguments);
int export_command(const ExportArguments& arguments);
int report_command(const ReportArguments& arguments);
int inspect_command(const InspectArguments& arguments);
int study_command(const StudyArguments& arguments);
int sweep_command(const SweepArguments& arguments);
int optimise_command(const OptimiseArguments& arguments);

/// Throws UsageError unless this machine runs the instruction set of that name; empty: none asked for.
void require_isa(const std::string& isa);

/// Writes to standard output. Throws FileError: a full disk behind a redirection must not look like success.
void tell(const std::string& text);
/// Logs each fault, or each note, as a line of its own.
void tell_faults(const std::filesystem::path& scene, const std::vector<Problem>& faults);
void tell_notes(const std::filesystem::path& scene, const std::vector<Problem>& notes);

/// The whole program but for `main`.
int command_line(int argc, char** argv);

} // namespace grandamp
