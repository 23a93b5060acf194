// TOML text to a tree, safe for any bytes, and overrides of single keys. Internal to io.
#pragma once

#include "io/scene_table.hpp"

#include <string>
#include <toml++/toml.h>
#include <vector>

namespace grandamp {

/// Throws SceneError with line and column where the text is no TOML, or nests or is larger than any scene would.
toml::table parse_toml(const std::string& text);

/// Puts one "KEY=VALUE" into the tree: the key dotted, list items by index, the value TOML or a bare word. Tables on
/// the way are made. Notes the key in reading.overridden, or a fault in reading.findings.
void apply_override(toml::table& tree, const std::string& text, SceneReading& reading);

/// Takes a dotted key out of the tree, if it is there.
void erase_key(toml::table& tree, const std::string& key);

/// Puts a string in place of the value of a dotted key.
void replace_string(toml::table& tree, const std::string& key, const std::string& value);

/// The line of every dotted key, 1-based; lists count as one key, lists of tables by index.
std::map<std::string, int> lines_of(const toml::table& tree);

} // namespace grandamp
