#include "io/csv_text.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace grandamp {

namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{4} << 30;

CsvContent unreadable(const std::string& why) {
  return {{}, "cannot be read: " + why};
}

} // namespace

CsvContent read_csv(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return unreadable("no such file");
  // A device or a pipe could go on for ever.
  if (!std::filesystem::is_regular_file(status)) return unreadable("not a regular file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return unreadable(std::strerror(errno));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return unreadable(error.message());
  if (size > largest_file) return unreadable("larger than 4 GiB");
  CsvContent content;
  content.text.resize(size);
  stream.read(content.text.data(), static_cast<std::streamsize>(size));
  content.text.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) return unreadable(std::strerror(errno));
  return content;
}

void skip_byte_order_mark(std::string_view& content) {
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view next_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

std::string_view next_field(std::string_view& rest, bool& more) {
  const std::size_t end = rest.find(',');
  more = end != std::string_view::npos;
  const std::string_view field = rest.substr(0, end);
  rest.remove_prefix(more ? end + 1 : rest.size());
  return trimmed(field);
}

} // namespace grandamp
