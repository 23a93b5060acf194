// `grandamp sweep`: a run per point of a grid of scene keys and per seed, side by side; tables and pictures of them
// all.
#pragma once

#include "io/case_options.hpp"
#include "io/scene_file.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

struct SweepOptions : CaseOptions {
  std::vector<std::string> vary;      ///< KEY=START:STOP:COUNT[:log] or KEY=a,b,c
  std::vector<std::string> overrides; ///< KEY=VALUE that the document has already: only to refuse what is varied too
  bool keep_total_mass = false;
  int index = 0, of = 1; ///< which part of how many
};

struct SweepResult {
  bool interrupted = false;
  std::size_t planned = 0, done = 0, failed = 0; ///< of the whole sweep
  std::size_t part_planned = 0, part_done = 0, part_failed = 0;
  std::string json; ///< the text of sweep.json
};

/// Runs what `folder` does not hold yet and writes the tables of all that it then holds. `name`: the scene's file, for
/// messages. Throws UsageError (bad options; the folder holds something else), SceneError (no point of the grid is a
/// scene that can be run), FileError.
SweepResult sweep(const SceneDocument& document, const std::string& name, const std::filesystem::path& folder,
                  const SweepOptions& options);

} // namespace grandamp
