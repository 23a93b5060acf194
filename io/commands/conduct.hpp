// What running a scene and going on with one have in common: signals, progress, messages, exit status.
#pragma once

#include "io/run.hpp"

#include <filesystem>
#include <functional>

namespace grandamp {

/// Lets `work` run with options that listen to signals and tell of progress, notes (of the scene file) and warnings,
/// and tells how it ended. Returns the exit status.
int conduct(const std::filesystem::path& scene, const std::filesystem::path& folder, RunSceneOptions options,
            bool quiet, bool json, const std::function<RunResult(const RunSceneOptions&)>& work);

} // namespace grandamp
