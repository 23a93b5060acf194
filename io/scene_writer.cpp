#include "io/scene_writer.hpp"

#include "io/scene_keys.hpp"

#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace grandamp {

namespace {

std::string written_number(double value) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0"; // otherwise it would read as an integer
  return text;
}

bool is_list_of_tables(const toml::node& node) {
  const toml::array* array = node.as_array();
  return array != nullptr && !array->empty() && array->front().is_table();
}

/// `path` has the indices of lists, which headers and the order of keys do not.
void write_table(const toml::table& table, const std::string& path, std::string& text) {
  const std::span<const std::string_view> keys = keys_of_table(table_of_path(path));
  for (const std::string_view key : keys) {
    const toml::node* node = table.get(key);
    if (node == nullptr || node->is_table() || is_list_of_tables(*node)) continue;
    text += fmt::format("{} = {}\n", key, written(*node));
  }
  for (const std::string_view key : keys) {
    const toml::node* node = table.get(key);
    if (node == nullptr) continue;
    const std::string inner = path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
    if (const toml::table* one = node->as_table()) {
      text += fmt::format("\n[{}]\n", inner);
      write_table(*one, inner, text);
    } else if (is_list_of_tables(*node)) {
      const toml::array& list = *node->as_array();
      for (std::size_t i = 0; i < list.size(); ++i) {
        text += fmt::format("\n[[{}]]\n", inner);
        write_table(*list[i].as_table(), fmt::format("{}.{}", inner, i), text);
      }
    }
  }
}

} // namespace

std::string written(const toml::node& value) {
  if (const toml::value<double>* number = value.as_floating_point()) return written_number(number->get());
  if (const toml::array* array = value.as_array()) {
    std::string text = "[";
    for (std::size_t i = 0; i < array->size(); ++i) text += (i == 0 ? "" : ", ") + written((*array)[i]);
    return text + ']';
  }
  std::ostringstream stream;
  value.visit([&stream](const auto& known) {
    if constexpr (toml::is_value<decltype(known)>) stream << known;
  });
  return stream.str();
}

std::string write_scene_tree(const toml::table& tree) {
  std::string text;
  write_table(tree, "", text);
  return text;
}

} // namespace grandamp
