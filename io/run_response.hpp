// From a run to its frequency response: what its scene says of the force and of the structure, and the files of it.
#pragma once

#include "io/frequency_response.hpp"
#include "io/results.hpp"
#include "solver/scene.hpp"

#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

/// The histories that it takes.
inline const std::vector<std::string> response_columns{"time", "displacement", "velocity", "excitation"};

/// Whether a run of the scene ends with a frequency response: a structure under a force of many frequencies.
bool gives_response(const Scene& scene);

/// From the histories of a run of the scene. Throws UsageError with the reason where there is no response, FileError
/// where the histories are damaged.
FrequencyResponse run_response(const Scene& scene, const History& history, const ResponseSettings& settings = {});

/// Whether the file's ending is one that write_response knows: .csv, .unv, .uff, .svg.
bool is_response_file(const std::filesystem::path& file);

/// A table, a universal file or a picture, by the file's ending. Throws FileError.
void write_response(const FrequencyResponse& response, const Scene& scene, const std::filesystem::path& file,
                    std::time_t now);

/// The structure in closed form, without granules and with them as added mass.
LinearHost linear_host(const Scene& scene);

} // namespace grandamp
