// What a run does before t = 0: granules placed and poured, with checkpoints on the way. Internal to io.
#pragma once

#include "io/recorder.hpp"
#include "io/run.hpp"
#include "io/run_folder.hpp"

#include <optional>
#include <string>

namespace grandamp {

struct Preparation {
  std::optional<Simulation> simulation; ///< none if it was stopped
  double wall_time = 0.0;               ///< s, of all parts of the run
  RunResult stopped;                    ///< then
};

/// Places the granules of the scene and pours them, on `isa` (empty: the best). A checkpoint that is written on the way
/// begins the folder. `so_far`: that of a run that was stopped while it poured, which goes on by the same bits.
/// Throws SceneError, GuardError, FileError, StateError.
Preparation prepare(const SceneDocument& document, const std::string& isa, RunFolder& files,
                    const RunSceneOptions& options, const RecorderSetup& setup, const Checkpoint* so_far = nullptr);

/// Records a prepared run from t = 0 to its end. `text`: of scene.toml and results.h5.
RunResult record_from_the_start(Preparation& preparation, const std::string& text, RunFolder& files,
                                const RunSceneOptions& options, RecorderSetup setup);

/// All of a run, from the placing of its granules on, into a folder that holds no run yet.
RunResult run_anew(const SceneDocument& document, RunFolder& files, const RunSceneOptions& options);

} // namespace grandamp
