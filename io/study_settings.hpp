// The settings that a study compares. Each is a list of overrides of the scene, so that whoever reads the study can run
// any of them by hand. Internal to io.
#pragma once

#include "io/scene_file.hpp"
#include "solver/contact_error.hpp"
#include "solver/plan.hpp"

#include <string>
#include <vector>

namespace grandamp {

struct StudySetting {
  std::string name;                     ///< "steps-8": of its files
  std::string group;                    ///< one of study_groups
  std::string label;                    ///< in words
  std::vector<std::string> overrides{}; ///< KEY=VALUE
  bool own = false;                     ///< the scene's own settings
  bool reference = false;               ///< what the others are held against
  bool audited = false;                 ///< missed contacts are counted, in a run of its own
  bool other_truth = false;             ///< another model, not only another way to follow it
  double steps_per_contact = 0.0;       ///< T_c over the step
  double time_step = 0.0;               ///< s
  double seconds = 0.0;                 ///< estimated, of one run on one thread
  ContactError contact{};               ///< of single contacts at its step
  RestitutionMet restitution{};
};

struct StudySettings {
  std::vector<StudySetting> settings;
  std::vector<std::string> left_out; ///< what the scene or the program does not bear, and why
};

/// `vary` as in StudyOptions. Throws SceneError if the scene itself is bad.
StudySettings study_settings(const SceneDocument& document, const std::string& name,
                             const std::vector<std::string>& vary, const std::string& isa);

/// The scene under overrides. Throws SceneError.
SceneDocument scene_under(const SceneDocument& document, const std::string& name,
                          const std::vector<std::string>& overrides);

} // namespace grandamp
