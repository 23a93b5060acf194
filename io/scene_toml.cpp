#include "io/scene_toml.hpp"

#include "io/scene_writer.hpp"

#include <charconv>
#include <fmt/format.h>

namespace grandamp {

namespace {

constexpr std::size_t largest_text = std::size_t{64} << 20; // bytes
constexpr int most_dots = 16;                               // in one key; a scene has at most two

[[noreturn]] void refuse(int line, const std::string& message, const std::string& allowed) {
  throw SceneError(Problem{"", "", message, allowed, line});
}

/// What toml++ 3.3 does not stand is refused before it. It looks up white space beyond ASCII in a table whose gaps are
/// undefined behaviour, and TOML has no such characters outside strings and comments anyhow. And it bounds how deep
/// lists and inline tables nest, but a dotted key of a hundred thousand parts makes as many tables within each other,
/// and their end is one call within the other. Follows TOML's rules for strings and comments.
class TextCheck {
public:
  explicit TextCheck(const std::string& text) : text_(text) {}

  void run() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3; // a byte order mark
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (static_cast<unsigned char>(c) >= 0x80) {
        refuse(line_, "a character outside ASCII", "such characters within \"strings\" and # comments alone");
      } else {
        if (c == '\n') ++line_;
        if (c == '.') {
          if (++dots_ > most_dots) refuse(line_, "a key of too many parts", "dotted keys of a few parts");
        } else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{' || c == '}' || c == ']') {
          dots_ = 0;
        }
        ++at_;
      }
    }
  }

private:
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool many_lines = text_.compare(at_, 3, three) == 0;
    at_ += many_lines ? 3 : 1;
    while (at_ < text_.size()) {
      if (text_[at_] == '\\' && quote == '"') {
        if (at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++line_;
        at_ += 2;
      } else if (many_lines && text_.compare(at_, 3, three) == 0) {
        at_ += 3;
        while (at_ < text_.size() && text_[at_] == quote) ++at_; // up to two quotes may end the string's own text
        return;
      } else if (!many_lines && (text_[at_] == quote || text_[at_] == '\n')) {
        if (text_[at_] == quote) ++at_; // an unended string is the parser's to report
        return;
      } else {
        if (text_[at_] == '\n') ++line_;
        ++at_;
      }
    }
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
  int dots_ = 0;
};

std::vector<std::string> parts_of(const std::string& key) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = key.find('.', begin);
    parts.push_back(key.substr(begin, dot == std::string::npos ? dot : dot - begin));
    if (dot == std::string::npos) return parts;
    begin = dot + 1;
  }
}

/// The item of a list that a part of a key names; null: none.
toml::node* item_of(toml::array& array, const std::string& part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc() || end != part.data() + part.size() || index >= array.size()) return nullptr;
  return array.get(index);
}

toml::node* child_of(toml::node& node, const std::string& part) {
  if (toml::table* table = node.as_table()) return table->get(part);
  if (toml::array* array = node.as_array()) return item_of(*array, part);
  return nullptr;
}

toml::node* find_key(toml::table& tree, const std::vector<std::string>& parts) {
  toml::node* node = &tree;
  for (const std::string& part : parts) {
    node = child_of(*node, part);
    if (node == nullptr) return nullptr;
  }
  return node;
}

/// A table with the key "value": a TOML value, or else the text itself as a string; empty if it is no text either.
toml::table parsed_value(const std::string& text) {
  if (text.find('\n') == std::string::npos) {
    try {
      toml::table holder = parse_toml("value = " + text);
      if (holder.size() == 1) return holder;
    } catch (const SceneError&) {
      // a bare word then
    }
  }
  try {
    toml::table holder{{"value", text}};
    if (parse_toml("value = " + written(*holder.get("value"))) == holder)
      return holder; // not so with bytes that are no UTF-8
  } catch (const SceneError&) {
  }
  return {};
}

void put(toml::node& parent, const std::string& part, const toml::node& value) {
  value.visit([&](const auto& known) {
    if (toml::table* table = parent.as_table()) {
      table->insert_or_assign(part, known);
    } else if (toml::array* array = parent.as_array()) {
      std::size_t index = 0;
      std::from_chars(part.data(), part.data() + part.size(), index);
      array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(index), known);
    }
  });
}

} // namespace

toml::table parse_toml(const std::string& text) {
  if (text.size() > largest_text)
    refuse(0, fmt::format("a scene of {} MiB", text.size() >> 20),
           "at most 64 MiB; many granules fit better in a CSV `file`");
  TextCheck(text).run();
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw SceneError(Problem{"", "", fmt::format("column {}: {}", at.column, error.description()),
                             "TOML, as described at https://toml.io", static_cast<int>(at.line)});
  }
}

void apply_override(toml::table& tree, const std::string& text, SceneReading& reading) {
  const auto refused = [&](const std::string& key, const std::string& message, const std::string& allowed) {
    reading.add({Problem{key, "", fmt::format("{} (given by --set {})", message, text), allowed}});
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return refused("", "not KEY=VALUE", "a dotted key, \"=\" and a value: granules.0.count=100");
  const auto trimmed = [](std::string part) {
    while (!part.empty() && part.back() == ' ') part.pop_back();
    return part.substr(std::min(part.find_first_not_of(' '), part.size()));
  };
  const std::string key = trimmed(text.substr(0, equals));
  const std::vector<std::string> parts = parts_of(key);
  if (parts.size() > most_dots) return refused(key, "a key of too many parts", "dotted keys of a few parts");
  toml::node* node = &tree;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) return refused(key, "an empty part in the key", "a dotted key: granules.0.count=100");
    const bool last = i + 1 == parts.size();
    toml::node* child = child_of(*node, parts[i]);
    if (toml::array* array = node->as_array(); array != nullptr && child == nullptr)
      return refused(key, fmt::format("no item {} in a list of {}", parts[i], array->size()),
                     array->empty() ? "the whole list" : fmt::format("an item from 0 to {}", array->size() - 1));
    if (!node->is_table() && !node->is_array())
      return refused(key, fmt::format("{} stands within a single value", parts[i]), "a key of a table");
    if (last) break;
    if (child == nullptr) {
      put(*node, parts[i], toml::table{});
      child = child_of(*node, parts[i]);
    }
    node = child;
  }
  const toml::table holder = parsed_value(trimmed(text.substr(equals + 1)));
  if (holder.empty()) return refused(key, "neither a TOML value nor a word", "a TOML value or a word in UTF-8");
  put(*node, parts.back(), *holder.get("value"));
  reading.overridden[key] = text;
}

void erase_key(toml::table& tree, const std::string& key) {
  std::vector<std::string> parts = parts_of(key);
  const std::string last = parts.back();
  parts.pop_back();
  toml::node* parent = find_key(tree, parts);
  if (parent != nullptr && parent->is_table()) parent->as_table()->erase(last);
}

void replace_string(toml::table& tree, const std::string& key, const std::string& value) {
  std::vector<std::string> parts = parts_of(key);
  const std::string last = parts.back();
  parts.pop_back();
  if (toml::node* parent = find_key(tree, parts)) put(*parent, last, toml::value<std::string>{value});
}

namespace {

void collect_lines(const toml::table& table, const std::string& path, int depth, std::map<std::string, int>& lines) {
  constexpr int deepest = 4; // the contract's keys end at three
  for (const auto& [name, node] : table) {
    const std::string key = path.empty() ? std::string(name.str()) : fmt::format("{}.{}", path, name.str());
    const auto line = static_cast<int>(name.source().begin.line);
    lines[key] = line;
    if (depth == deepest) continue;
    if (const toml::table* inner = node.as_table()) collect_lines(*inner, key, depth + 1, lines);
    const toml::array* array = node.as_array();
    if (array == nullptr || array->empty() || !array->front().is_table()) continue;
    for (std::size_t i = 0; i < array->size(); ++i) {
      const toml::table* item = (*array)[i].as_table();
      if (item == nullptr) continue;
      const std::string item_key = fmt::format("{}.{}", key, i);
      lines[item_key] = static_cast<int>(item->source().begin.line);
      collect_lines(*item, item_key, depth + 1, lines);
    }
  }
}

} // namespace

std::map<std::string, int> lines_of(const toml::table& tree) {
  std::map<std::string, int> lines;
  collect_lines(tree, "", 1, lines);
  return lines;
}

} // namespace grandamp
