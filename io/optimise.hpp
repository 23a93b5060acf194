// `grandamp optimise`: the values of some scene keys for which a number of the summary is least, found from runs whose
// results are partly chance.
#pragma once

#include "io/case_options.hpp"
#include "io/scene_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

struct OptimiseOptions : CaseOptions {
  OptimiseOptions() { seeds = 3; }    // the same for all designs
  std::string number;                 ///< of the summary, dotted: "structure.rms_displacement"
  bool maximise = false;              ///< instead of minimise
  std::vector<std::string> over;      ///< KEY=A:B or KEY=A:B:log
  std::vector<std::string> overrides; ///< KEY=VALUE that the document has already: only to refuse what is free too
  bool keep_total_mass = false;
  int evaluations = 20; ///< designs at most
};

struct OptimiseResult {
  bool interrupted = false;
  std::string paragraph; ///< the best design, in words; empty: none is known yet
  std::string json;      ///< the text of optimise.json
};

/// Searches in three parts: designs that fill the space between the bounds, all at once; NLopt's subplex, made for
/// noisy functions, from the best of them; more seeds for those that cannot be told from the best. It ends when
/// `evaluations` are made, or when what the last ones gained is less than its standard error. Every run is kept in
/// `folder`: begun again, the search takes them from there and goes on. Throws UsageError, SceneError, FileError.
OptimiseResult optimise(const SceneDocument& document, const std::string& name, const std::filesystem::path& folder,
                        const OptimiseOptions& options);

} // namespace grandamp
