#include "io/scene_table.hpp"

#include "io/nearest_name.hpp"
#include "io/scene_keys.hpp"
#include "io/scene_writer.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grandamp {

namespace {

constexpr std::size_t longest_shown = 60;   // characters of a value in a message
constexpr std::size_t most_findings = 1000; // beyond, the file is no scene

void show(const toml::node& node, std::string& text, int depth) {
  if (text.size() > longest_shown) return;
  if (const toml::array* array = node.as_array()) {
    text += '[';
    for (std::size_t i = 0; i < array->size() && text.size() <= longest_shown; ++i) {
      if (i > 0) text += ", ";
      if (depth < 4) show((*array)[i], text, depth + 1);
    }
    text += ']';
  } else if (node.is_table()) {
    text += "{...}";
  } else {
    text += written(node);
  }
}

std::string dotted(std::string_view path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

} // namespace

std::string shown(const toml::node& node) {
  std::string text;
  show(node, text, 0);
  if (text.size() <= longest_shown) return text;
  std::size_t end = longest_shown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end; // not inside a UTF-8 character
  return text.substr(0, end) + "...";
}

bool Range::holds(double value) const noexcept {
  return (low_included ? value >= low : value > low) && (high_included ? value <= high : value < high);
}

std::string Range::text() const {
  const bool from = std::isfinite(low), to = std::isfinite(high);
  if (!from && !to) return "a finite number";
  const std::string lower = fmt::format("{} {}", low_included ? "at least" : "above", low);
  const std::string upper = fmt::format("{} {}", high_included ? "at most" : "below", high);
  if (!to) return "a number " + lower;
  if (!from) return "a number " + upper;
  return fmt::format("a number {} and {}", lower, upper);
}

bool SceneReading::is_overridden(const std::string& key) const {
  return !override_of(key).empty();
}

std::string SceneReading::override_of(const std::string& key) const {
  for (const auto& [path, text] : overridden)
    if (path == key || path.starts_with(key + '.') || key.starts_with(path + '.')) return text;
  return {};
}

void SceneReading::add(Finding finding) {
  if (findings.size() >= most_findings) return;
  for (const Finding& known : findings) // several rules may trip over one key in the same way: once is enough
    if (known.problem.key == finding.problem.key && known.problem.message == finding.problem.message) return;
  findings.push_back(std::move(finding));
}

TableReader::TableReader(SceneReading& reading, const toml::table* table, std::string path)
    : reading_(&reading), table_(table), path_(std::move(path)) {}

std::string TableReader::key_path(std::string_view key) const {
  return dotted(path_, key);
}

bool TableReader::has(std::string_view key) const {
  return table_ != nullptr && table_->contains(key);
}

const toml::node* TableReader::ask(std::string_view key) {
  pass(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

Finding TableReader::finding(std::string_view key, const std::string& message, const std::string& allowed) const {
  Finding result;
  result.problem.key = key_path(key);
  if (has(key)) result.problem.value = shown(*table_->get(key));
  result.problem.message = message;
  result.problem.allowed = allowed;
  return result;
}

void TableReader::wrong(std::string_view key, const std::string& message, const std::string& allowed) {
  reading_->add(finding(key, message, allowed));
}

void TableReader::missing(std::string_view key, const std::string& why, const std::string& allowed) {
  reading_->add(finding(key, "missing: " + why, allowed));
}

void TableReader::idle(std::string_view key, const std::string& why, const std::string& allowed) {
  pass(key);
  if (!has(key)) return;
  Finding result = finding(key, "does not apply: " + why, allowed);
  result.idle = true;
  reading_->add(std::move(result));
}

std::string_view TableReader::one_of(std::initializer_list<std::string_view> keys) {
  std::string_view in_force;
  bool overridden = false;
  for (const std::string_view key : keys) {
    pass(key);
    if (!has(key)) continue;
    const bool by_override = reading_->is_overridden(key_path(key));
    if (in_force.empty() || (by_override && !overridden)) {
      in_force = key;
      overridden = by_override;
    }
  }
  for (const std::string_view key : keys)
    if (key != in_force && has(key))
      idle(key, fmt::format("{} is given as well", in_force), fmt::format("one of {}", fmt::join(keys, ", ")));
  return in_force;
}

void TableReader::wrong_type(std::string_view key, const std::string& allowed) {
  const toml::node& node = *table_->get(key);
  std::string_view kind = "a value";
  switch (node.type()) {
  case toml::node_type::table:
    kind = "a table";
    break;
  case toml::node_type::array:
    kind = "a list";
    break;
  case toml::node_type::string:
    kind = "a string";
    break;
  case toml::node_type::integer:
    kind = "an integer";
    break;
  case toml::node_type::floating_point:
    kind = "a floating-point number";
    break;
  case toml::node_type::boolean:
    kind = "a boolean";
    break;
  case toml::node_type::date:
  case toml::node_type::time:
  case toml::node_type::date_time:
    kind = "a date or time";
    break;
  case toml::node_type::none:
    break;
  }
  wrong(key, fmt::format("wrong type: {}", kind), allowed);
}

std::optional<double> as_double(const toml::node* node) {
  if (node == nullptr) return std::nullopt;
  if (const toml::value<std::int64_t>* integer = node->as_integer()) return static_cast<double>(integer->get());
  return node->value_exact<double>();
}

std::optional<double> TableReader::finite(const toml::node& node, std::string_view key, const Range& range,
                                          const std::string& allowed) {
  const std::optional<double> value = as_double(&node);
  if (!value) return std::nullopt;
  if (!std::isfinite(*value)) {
    wrong(key, "not a finite number", allowed);
    return std::nullopt;
  }
  if (!range.holds(*value)) {
    wrong(key, "out of range", allowed);
    return std::nullopt;
  }
  return value;
}

std::optional<double> TableReader::number(std::string_view key, const Range& range) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_number()) {
    wrong_type(key, range.text());
    return std::nullopt;
  }
  return finite(*node, key, range, range.text());
}

std::optional<double> TableReader::number_or_word(std::string_view key, const Range& range, std::string_view word,
                                                  bool& said) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  const std::string allowed = fmt::format("{}, or \"{}\"", range.text(), word);
  said = node->value_exact<std::string>() == word;
  if (said) return std::nullopt;
  if (node->is_number()) return finite(*node, key, range, allowed);
  wrong_type(key, allowed);
  return std::nullopt;
}

std::optional<std::array<double, 2>> TableReader::pair(std::string_view key) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array != nullptr && array->size() == 2) {
    const std::optional<double> first = as_double(array->get(0)), second = as_double(array->get(1));
    if (first && second && std::isfinite(*first) && std::isfinite(*second)) return std::array{*first, *second};
  }
  wrong(key, "not two finite numbers", "a list of two numbers");
  return std::nullopt;
}

std::optional<std::int64_t> TableReader::integer(std::string_view key, std::int64_t low, std::int64_t high) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  const std::string allowed = fmt::format("an integer from {} to {}", low, high);
  if (!node->is_integer()) {
    wrong_type(key, allowed);
    return std::nullopt;
  }
  const std::int64_t value = *node->value<std::int64_t>();
  if (value >= low && value <= high) return value;
  wrong(key, "out of range", allowed);
  return std::nullopt;
}

std::optional<bool> TableReader::flag(std::string_view key) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) wrong_type(key, "true or false");
  return node->value_exact<bool>();
}

std::optional<std::string> TableReader::text(std::string_view key) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) wrong_type(key, "a string");
  return node->value_exact<std::string>();
}

std::optional<Vector3> TableReader::vector_of(const toml::node& node, std::string_view key, const Range& each,
                                              const std::string& item) {
  const std::string allowed = "three numbers [x, y, z], each " + each.text();
  const toml::array* array = node.as_array();
  const bool three = array != nullptr && array->size() == 3 &&
                     std::all_of(array->begin(), array->end(), [](const toml::node& one) { return one.is_number(); });
  if (!three) {
    wrong(key, fmt::format("{}not three numbers", item), allowed);
    return std::nullopt;
  }
  Vector3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = *as_double(array->get(i));
    if (!std::isfinite(value) || !each.holds(value)) {
      wrong(key,
            fmt::format("{}{} {}", item, shown((*array)[i]),
                        std::isfinite(value) ? "is out of range" : "is not a finite number"),
            allowed);
      return std::nullopt;
    }
    result[i] = value;
  }
  return result;
}

std::optional<std::array<std::string, 2>> TableReader::two_names(std::string_view key) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 2 || !(*array)[0].is_string() || !(*array)[1].is_string()) {
    wrong_type(key, "two names: [\"a\", \"b\"]");
    return std::nullopt;
  }
  return std::array{(*array)[0].value_or(std::string()), (*array)[1].value_or(std::string())};
}

std::optional<Vector3> TableReader::vector(std::string_view key, const Range& each) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  return vector_of(*node, key, each, "");
}

std::optional<Vector3> TableReader::direction(std::string_view key) {
  std::optional<Vector3> given = vector(key);
  if (!given) return std::nullopt;
  const double length = std::hypot((*given)[0], (*given)[1], (*given)[2]);
  if (!(length > 1e-150 && length < 1e150)) { // outside, a component over the length may be no number
    wrong(key, length > 1.0 ? "too long a vector" : "the zero vector has no direction",
          "three numbers [x, y, z], not all 0; the length does not matter");
    return std::nullopt;
  }
  for (double& component : *given) component /= length;
  return given;
}

std::optional<std::vector<Vector3>> TableReader::vectors(std::string_view key) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    wrong_type(key, "a list of [x, y, z]");
    return std::nullopt;
  }
  std::vector<Vector3> result;
  result.reserve(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::optional<Vector3> item = vector_of((*array)[i], key, any_number, fmt::format("item {}: ", i));
    if (!item) return std::nullopt; // the first faulty item tells enough
    result.push_back(*item);
  }
  return result;
}

const toml::table* TableReader::table(std::string_view key) {
  const toml::node* node = ask(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) wrong_type(key, fmt::format("a table, [{}]", key_path(key)));
  return node->as_table();
}

std::vector<const toml::table*> TableReader::tables(std::string_view key) {
  std::vector<const toml::table*> result;
  const toml::node* node = ask(key);
  if (node == nullptr) return result;
  const toml::array* array = node->as_array();
  const bool good = array != nullptr &&
                    std::all_of(array->begin(), array->end(), [](const toml::node& one) { return one.is_table(); });
  if (!good) {
    wrong_type(key, fmt::format("a list of tables, each with a header [[{}]]", key_path(key)));
    return result;
  }
  for (const toml::node& one : *array) result.push_back(one.as_table());
  return result;
}

std::optional<std::size_t> TableReader::word(std::string_view key, const std::vector<std::string_view>& allowed) {
  const toml::node* node = ask(key);
  if (node == nullptr) return std::nullopt;
  std::string list;
  for (const std::string_view one : allowed) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", one);
  if (!node->is_string()) {
    wrong_type(key, list);
    return std::nullopt;
  }
  const std::string value = *node->value_exact<std::string>();
  const auto found = std::find(allowed.begin(), allowed.end(), value);
  if (found != allowed.end()) return static_cast<std::size_t>(found - allowed.begin());
  const std::string_view nearest = nearest_name(value, allowed);
  wrong(key, nearest.empty() ? "unknown word" : fmt::format("unknown word, perhaps \"{}\"", nearest), list);
  return std::nullopt;
}

void TableReader::finish() {
  if (table_ == nullptr) return;
  const std::string table = table_of_path(path_);
  for (const auto& [name, node] : *table_) {
    const std::string_view key = name.str();
    if (asked_.contains(key)) continue;
    const std::span<const std::string_view> known = keys_of_table(table);
    const std::string elsewhere = other_tables_with(key, table);
    const std::string_view nearest = nearest_name(key, known);
    std::string message = "unknown key";
    if (!nearest.empty() && nearest != key)
      message += fmt::format(", perhaps {}", nearest);
    else if (!elsewhere.empty())
      message += fmt::format(" here; it belongs to {}", elsewhere);
    wrong(key, message, fmt::format("{}", fmt::join(known, ", ")));
  }
}

} // namespace grandamp
