// Comma-separated text: files read whole, and taken apart line by line and field by field.
#pragma once

#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace grandamp {

struct CsvContent {
  std::string text;
  std::string fault; ///< why it cannot be read; empty: it was
};

/// Enough to see what is wrong with a file.
inline constexpr std::size_t most_faults = 20;

/// A regular file of at most 4 GiB.
CsvContent read_csv(const std::filesystem::path& file);

void skip_byte_order_mark(std::string_view& content);
/// Without blanks at its ends.
std::string_view trimmed(std::string_view text);
/// Takes the first line off `rest`.
std::string_view next_line(std::string_view& rest);
/// Takes the first field off `rest`, trimmed; `more`: whether a comma followed.
std::string_view next_field(std::string_view& rest, bool& more);

/// All of the field as a number, a finite one.
template <class Number> bool read_number(std::string_view field, Number& number) {
  if (field.starts_with('+') && !field.starts_with("+-")) field.remove_prefix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (error != std::errc() || end != field.data() + field.size()) return false;
  if constexpr (std::is_floating_point_v<Number>) return std::isfinite(number);
  return true;
}

} // namespace grandamp
