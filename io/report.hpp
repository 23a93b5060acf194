// `grandamp report DIR`: one page of HTML that needs nothing but itself. Internal to io.
#pragma once

#include <filesystem>

namespace grandamp {

/// Writes report.html, and its still pictures into report/, beside what it tells of: a run, a sweep or a study. Returns
/// the path of the page. Throws UsageError if the folder holds nothing to tell of, FileError if a file cannot be read
/// (damaged ones are not told of) or written.
std::filesystem::path write_report(const std::filesystem::path& folder);

} // namespace grandamp
