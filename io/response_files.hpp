// What is written of a frequency response: a table, a picture.
#pragma once

#include "io/frequency_response.hpp"

#include <filesystem>
#include <string>

namespace grandamp {

/// Comma-separated with a header row, a line of the spectrum per row, 17 significant digits; the columns are told in
/// io/FORMAT.md.
std::string response_csv(const FrequencyResponse& response);

/// Magnitude (with the closed forms), phase, coherence, and the force's spectral density. An SVG document.
std::string response_svg(const FrequencyResponse& response, const std::string& title, bool granules);

} // namespace grandamp
