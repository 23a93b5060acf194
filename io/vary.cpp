#include "io/vary.hpp"

#include "io/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace grandamp {

namespace {

constexpr const char* forms = "KEY=START:STOP:COUNT, KEY=START:STOP:COUNT:log or KEY=a,b,c";

[[noreturn]] void refuse(const std::string& text, const std::string& why, const std::string& allowed) {
  throw UsageError(fmt::format("--vary {}: {}; allowed: {}", text, why, allowed));
}

std::string trimmed(std::string text) {
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

std::optional<double> number_of(const std::string& text) {
  if (text.empty() || text.find_first_of("xXnN") != std::string::npos) return std::nullopt; // hexadecimal, nan, inf
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// At separators that stand in no bracket and in no string.
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    }
    if (c == separator && depth == 0 && quote == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

VaryValue value_of(const std::string& key, double number) {
  const double value = is_whole_key(key) ? std::round(number) : number;
  return {value_text(key, value), value};
}

std::vector<VaryValue> range_of(const std::string& text, const std::string& key,
                                const std::vector<std::string>& parts) {
  const bool logarithmic = parts.size() == 4;
  if (parts.size() < 3 || parts.size() > 4 || (logarithmic && parts[3] != "log")) refuse(text, "not a range", forms);
  const std::optional<double> start = number_of(parts[0]), stop = number_of(parts[1]), count = number_of(parts[2]);
  if (!start) refuse(text, fmt::format("START \"{}\" is no number", parts[0]), forms);
  if (!stop) refuse(text, fmt::format("STOP \"{}\" is no number", parts[1]), forms);
  if (!count || *count != std::round(*count) || *count < 1.0 || *count > static_cast<double>(most_cases))
    refuse(text, fmt::format("COUNT \"{}\" is no number of points", parts[2]),
           fmt::format("a whole number from 1 to {}", most_cases));
  if (*count == 1.0 && *start != *stop)
    refuse(text, "one point cannot be both START and STOP", "a COUNT of 2 or more, or KEY=VALUE");
  if (*count > 1.0 && *start == *stop) refuse(text, "START and STOP are the same", "a range, or KEY=VALUE");
  if (logarithmic && !(*start * *stop > 0.0))
    refuse(text, "steps by equal factors lead from START to STOP only where both have one sign and neither is 0",
           "START and STOP above 0");
  std::vector<VaryValue> values;
  const auto points = static_cast<std::size_t>(*count);
  for (std::size_t k = 0; k < points; ++k) {
    const double share = points > 1 ? static_cast<double>(k) / (*count - 1.0) : 0.0;
    double value = logarithmic ? *start * std::pow(*stop / *start, share) : *start + share * (*stop - *start);
    if (k + 1 == points) value = *stop;
    // 15.5 + 0.3 is 15.8 to a reader, whatever the last bit of the sum says.
    if (k > 0 && k + 1 < points) value = std::stod(fmt::format("{:.13g}", value));
    values.push_back(value_of(key, value));
  }
  return values;
}

} // namespace

bool VariedKey::numeric() const {
  return std::all_of(values.begin(), values.end(), [](const VaryValue& value) { return value.number.has_value(); });
}

bool is_whole_key(const std::string& key) {
  constexpr std::array<std::string_view, 5> whole{"count", "seed", "max_interval", "interval", "audit"};
  const std::size_t dot = key.rfind('.');
  const std::string last = dot == std::string::npos ? key : key.substr(dot + 1);
  return std::find(whole.begin(), whole.end(), last) != whole.end();
}

std::string value_text(const std::string& key, double value) {
  if (is_whole_key(key) && std::abs(value) < 1e15) return fmt::format("{}", static_cast<std::int64_t>(value));
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0"; // otherwise it would read as an integer
  return text;
}

VariedKey parse_vary(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse(text, "no \"=\"", forms);
  VariedKey varied;
  varied.key = trimmed(text.substr(0, equals));
  if (varied.key.empty()) refuse(text, "no key before the \"=\"", forms);
  const std::string right = trimmed(text.substr(equals + 1));
  if (right.empty()) refuse(text, "no values after the \"=\"", forms);
  const std::vector<std::string> listed = split(right, ','), ranged = split(right, ':');
  if (listed.size() == 1 && ranged.size() > 1) {
    varied.values = range_of(text, varied.key, ranged);
  } else {
    for (const std::string& one : listed) {
      if (one.empty()) refuse(text, "an empty value in the list", "KEY=a,b,c");
      const std::optional<double> number = number_of(one);
      if (!number && number_of(one.substr(0, 1)) && one.find(':') != std::string::npos)
        refuse(text, fmt::format("\"{}\" is a range within a list", one), forms);
      if (number && is_whole_key(varied.key) && *number != std::round(*number))
        refuse(text, fmt::format("{} is no whole number", one), "whole numbers");
      varied.values.push_back(number ? value_of(varied.key, *number) : VaryValue{one, std::nullopt});
    }
  }
  for (std::size_t a = 0; a < varied.values.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (varied.values[a].text == varied.values[b].text)
        refuse(text,
               fmt::format("{} comes twice{}", varied.values[a].text,
                           is_whole_key(varied.key) ? " (whole numbers are rounded)" : ""),
               "values that differ");
  return varied;
}

std::vector<VariedKey> parse_vary(const std::vector<std::string>& texts, const std::vector<std::string>& overrides,
                                  std::size_t seeds) {
  if (texts.empty()) throw UsageError(fmt::format("nothing to vary; say --vary {}", forms));
  std::vector<VariedKey> keys;
  std::size_t cases = seeds;
  for (const std::string& text : texts) {
    keys.push_back(parse_vary(text));
    const std::string& key = keys.back().key;
    if (key == "seed") refuse(text, "seeds are not varied as a key", "--seeds N");
    for (std::size_t k = 0; k + 1 < keys.size(); ++k)
      if (keys[k].key == key) refuse(text, "the key is varied twice", "one --vary for each key");
    for (const std::string& one : overrides)
      if (trimmed(one.substr(0, one.find('='))) == key)
        refuse(text, fmt::format("--set {} gives the same key", one), "one of --set and --vary");
    cases *= keys.back().values.size();
    if (cases > most_cases)
      throw UsageError(
          fmt::format("a grid of {} cases or more (points times seeds); allowed: at most {}", cases, most_cases));
  }
  return keys;
}

std::vector<std::vector<VaryValue>> grid_points(const std::vector<VariedKey>& keys) {
  std::vector<std::vector<VaryValue>> points(1);
  for (const VariedKey& key : keys) {
    std::vector<std::vector<VaryValue>> longer;
    for (const std::vector<VaryValue>& point : points)
      for (const VaryValue& value : key.values) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    points = std::move(longer);
  }
  return points;
}

} // namespace grandamp
