// The pages of a sweep and of a search for a design. Internal to io.
#pragma once

#include "io/report_page.hpp"

#include <filesystem>

namespace grandamp::report {

/// From sweep.json, and response.csv where there is one. Throws FileError.
Page sweep_page(const std::filesystem::path& folder);
/// From optimise.json. Throws FileError.
Page optimise_page(const std::filesystem::path& folder);

} // namespace grandamp::report
