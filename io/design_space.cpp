#include "io/design_space.hpp"

#include "io/run.hpp"
#include "io/scene_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace grandamp {

namespace {

constexpr const char* forms = "KEY=A:B or KEY=A:B:log, A below B";
constexpr std::array<int, 10> primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw UsageError(fmt::format("--over {}: {}; allowed: {}", text, why, forms));
}

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) {
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    parts.push_back(part);
  }
  return parts;
}

double bound_of(const std::string& text, const std::string& part) {
  char* end = nullptr;
  const double value = std::strtod(part.c_str(), &end);
  if (part.empty() || end != part.c_str() + part.size() || !std::isfinite(value))
    refuse(text, fmt::format("\"{}\" is no number", part));
  return value;
}

} // namespace

double FreeKey::at(double share) const {
  const double inside = std::clamp(share, 0.0, 1.0);
  if (inside == 0.0) return low;
  if (inside == 1.0) return high;
  return logarithmic ? low * std::pow(high / low, inside) : low + inside * (high - low);
}

double FreeKey::share_of(double value) const {
  return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

FreeKey parse_over(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) refuse(text, "not KEY=A:B");
  FreeKey key;
  key.key = parts_of(text.substr(0, equals), '=').front();
  const std::vector<std::string> parts = parts_of(text.substr(equals + 1), ':');
  if (parts.size() < 2 || parts.size() > 3 || (parts.size() == 3 && parts[2] != "log")) refuse(text, "no two bounds");
  key.low = bound_of(text, parts[0]);
  key.high = bound_of(text, parts[1]);
  key.logarithmic = parts.size() == 3;
  if (!(key.low < key.high)) refuse(text, fmt::format("{} is not below {}", parts[0], parts[1]));
  if (key.logarithmic && !(key.low > 0.0)) refuse(text, "equal factors need bounds above 0");
  if (key.key == "seed") refuse(text, "seeds are chance, not design (--seeds N)");
  if (is_whole_key(key.key) && std::floor(key.high) < std::ceil(key.low))
    refuse(text, "there is no whole number between the bounds");
  if (is_whole_key(key.key)) {
    key.low = std::ceil(key.low);
    key.high = std::floor(key.high);
  }
  return key;
}

std::vector<FreeKey> parse_over(const std::vector<std::string>& texts, const std::vector<std::string>& overrides) {
  if (texts.empty()) throw UsageError(fmt::format("nothing to choose; say --over {}", forms));
  if (texts.size() > primes.size())
    throw UsageError(fmt::format("{} keys to choose; allowed: at most {}", texts.size(), primes.size()));
  std::vector<FreeKey> keys;
  for (const std::string& text : texts) {
    FreeKey key = parse_over(text);
    for (const FreeKey& other : keys)
      if (other.key == key.key) refuse(text, "the key comes twice");
    for (const std::string& one : overrides)
      if (parts_of(one, '=').front() == key.key) refuse(text, fmt::format("--set {} gives the same key", one));
    keys.push_back(std::move(key));
  }
  return keys;
}

std::vector<VaryValue> values_at(const std::vector<FreeKey>& keys, const std::vector<double>& point) {
  std::vector<VaryValue> values;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    double value = keys[i].at(point[i]);
    // Six digits are more than any design can be made to, and easier to read.
    if (point[i] > 0.0 && point[i] < 1.0) value = std::stod(fmt::format("{:.6g}", value));
    if (is_whole_key(keys[i].key)) value = std::round(value);
    values.push_back({value_text(keys[i].key, value), value});
  }
  return values;
}

std::optional<double> number_in(const std::string& scene_text, const std::string& key) {
  const toml::table tree = parse_toml(scene_text);
  const toml::node* node = &tree;
  for (const std::string& part : parts_of(key, '.')) {
    if (const toml::table* table = node->as_table()) {
      node = table->get(part);
    } else if (const toml::array* array = node->as_array()) {
      char* end = nullptr;
      const unsigned long index = std::strtoul(part.c_str(), &end, 10);
      node = end != part.c_str() && *end == '\0' && index < array->size() ? array->get(index) : nullptr;
    } else {
      node = nullptr;
    }
    if (node == nullptr) return std::nullopt;
  }
  return as_double(node);
}

std::vector<double> halton_point(std::size_t index, std::size_t dimensions) {
  std::vector<double> point;
  for (std::size_t i = 0; i < dimensions; ++i) {
    const auto base = static_cast<std::size_t>(primes[i]);
    double share = 0.0, digit = 1.0;
    for (std::size_t left = index; left > 0; left /= base) {
      digit /= static_cast<double>(base);
      share += digit * static_cast<double>(left % base);
    }
    point.push_back(share);
  }
  return point;
}

} // namespace grandamp
