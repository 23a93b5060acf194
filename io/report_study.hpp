// The page of a study. Internal to io.
#pragma once

#include "io/report_page.hpp"

#include <filesystem>

namespace grandamp::report {

/// From study.json. Throws FileError.
Page study_page(const std::filesystem::path& folder);

} // namespace grandamp::report
