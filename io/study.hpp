// `grandamp study accuracy`: what accuracy costs in time. One scene, run under many settings and from several seeds;
// error against time, step by step, and what to choose for an error asked for.
#pragma once

#include "io/scene_file.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace grandamp {

/// What a study varies, and the order in which it is told.
inline constexpr const char* study_groups[] = {"steps", "integrator", "precision", "policy",
                                               "skin",  "friction",   "stiffness"};

struct StudyOptions {
  double error = 0.01;                          ///< that settings are recommended for
  int seeds = 3;                                ///< runs of each setting, from seeds that follow the scene's
  std::vector<std::string> vary;                ///< of study_groups; empty: all. "steps" is always part of it
  int threads = 0;                              ///< in all; 0: what the process may use
  std::string isa;                              ///< empty: the best
  double max_wall = 0.0;                        ///< s after which it stops as if interrupted; 0: no end
  bool force = false;                           ///< replace what the folder holds
  std::function<void(const std::string&)> tell; ///< the plan, and what is left out
  std::function<void(std::size_t done, std::size_t all, double seconds, double left)> progress;
  std::function<bool()> stop_requested; ///< asked about every millisecond, by several threads
};

struct StudyResult {
  bool interrupted = false;
  std::string paragraph; ///< the recommendation; empty: too little is done for one
  std::string json;      ///< the text of study.json
};

/// Runs what is not yet in `folder`, a file per case in cases/, and writes study.csv, study.json, study.md and pictures
/// from all that is. `name`: the scene's file, for messages. Throws SceneError (no granules, or a bad scene),
/// UsageError (the folder holds something else), FileError.
StudyResult study_accuracy(const SceneDocument& document, const std::string& name, const std::filesystem::path& folder,
                           const StudyOptions& options);

} // namespace grandamp
