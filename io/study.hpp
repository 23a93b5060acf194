// `grandamp study accuracy`: what accuracy costs in time. One scene, run under many settings and from several seeds;
// error against time, step by step, and what to choose for an error asked for.
#pragma once

#include "io/case_options.hpp"
#include "io/scene_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

/// What a study varies, and the order in which it is told.
inline constexpr const char* study_groups[] = {"steps", "integrator", "precision", "policy",
                                               "skin",  "friction",   "stiffness"};

struct StudyOptions : CaseOptions {
  StudyOptions() { seeds = 3; }
  double error = 0.01;           ///< that settings are recommended for
  std::vector<std::string> vary; ///< of study_groups; empty: all. "steps" is always part of it
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
