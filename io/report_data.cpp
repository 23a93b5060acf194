#include "io/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace grandamp::report {

static_assert(std::endian::native == std::endian::little, "pages carry numbers as they lie in memory");

Rows thinned(const Rows& rows, std::size_t most) {
  const std::size_t count = rows.time.size();
  if (count <= most) return rows;
  const std::size_t buckets = most / 2;
  Rows thin;
  thin.columns.resize(rows.columns.size());
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::size_t first = bucket * count / buckets, last = (bucket + 1) * count / buckets; // one past
    thin.time.push_back(rows.time[first]);
    thin.time.push_back(rows.time[last - 1]);
    for (std::size_t c = 0; c < rows.columns.size(); ++c) {
      const auto begin = rows.columns[c].begin();
      const auto [lowest, highest] =
          std::minmax_element(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last));
      thin.columns[c].push_back(lowest < highest ? *lowest : *highest);
      thin.columns[c].push_back(lowest < highest ? *highest : *lowest);
    }
  }
  return thin;
}

std::string base64(std::span<const std::byte> bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (at + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[at + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += at + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::vector<float> as_floats(const std::vector<double>& values) {
  std::vector<float> floats;
  floats.reserve(values.size());
  for (const double value : values) floats.push_back(static_cast<float>(value));
  return floats;
}

std::uint16_t quantised(double value, double low, double high, std::uint16_t most) {
  if (!(high > low)) return 0;
  const double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return static_cast<std::uint16_t>(std::lround(share * most));
}

ReadableUnit readable_unit(double largest, std::string_view unit) {
  struct Prefix {
    double size;
    const char* name;
  };
  static constexpr std::array prefixes{Prefix{1e6, "M"},  Prefix{1e3, "k"},  Prefix{1.0, ""},   Prefix{1e-3, "m"},
                                       Prefix{1e-6, "µ"}, Prefix{1e-9, "n"}, Prefix{1e-12, "p"}};
  const double size = std::abs(largest);
  if (unit.empty() || unit == "1") return {1.0, ""};
  if (!(size > 0.0) || !std::isfinite(size)) return {1.0, std::string(unit)};
  const bool kilogram = unit == "kg";
  const std::string base(kilogram ? "g" : unit);
  const double scale = kilogram ? 1e3 : 1.0;
  for (const Prefix& prefix : prefixes)
    if (size * scale >= 0.9995 * prefix.size || &prefix == &prefixes.back())
      return {scale / prefix.size, prefix.name + base};
  return {1.0, std::string(unit)};
}

std::string readable(double value, std::string_view unit, int digits) {
  if (!std::isfinite(value)) return "not known";
  const ReadableUnit scaled = readable_unit(value, unit);
  const double number = value * scaled.factor;
  const bool whole = std::abs(number) >= std::pow(10.0, digits) && std::abs(number) < 1e6; // 320, not 3.2e+02
  return (whole ? fmt::format("{:.0f}", number) : fmt::format("{:.{}g}", number, digits)) +
         (scaled.name.empty() ? "" : " " + scaled.name);
}

} // namespace grandamp::report
