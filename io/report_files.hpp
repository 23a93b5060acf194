// What a report reads beside results.h5. Internal to io.
#pragma once

#include "io/json.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace grandamp::report {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// A number of a JSON object by its path ("structure/amplitude"); NaN where there is none.
double number(const Json& json, std::string_view path);
/// The same for a key with dots or slashes in it.
double number_of(const Json& object, const std::string& key);
/// A text by its path; empty where there is none.
std::string text(const Json& json, std::string_view path);

/// A JSON object that has these members, each an array. Throws FileError.
Json read_json(const std::filesystem::path& file, const std::vector<std::string>& arrays = {});

/// Columns of numbers; what is no number is NaN.
struct CsvColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
  const std::vector<double>* find(std::string_view name) const; ///< null: there is none
};
/// Comma-separated with a header row. Throws FileError if it cannot be read or a row has another width.
CsvColumns read_csv(const std::filesystem::path& file);

/// When a file was last written, UTC; empty if that is not known.
std::string time_of(const std::filesystem::path& file);
/// The title, or without one the folder's name.
std::string title_of(const Json& json, const std::filesystem::path& folder);

} // namespace grandamp::report
