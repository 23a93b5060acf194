// A scene's TOML tree as text. Internal to io.
#pragma once

#include <string>
#include <toml++/toml.h>

namespace grandamp {

/// A number, word or list as TOML; numbers in the shortest form that reads back to the same bits.
std::string written(const toml::node& value);

/// The tree of a scene without faults, its tables and keys in the order of the contract.
std::string write_scene_tree(const toml::table& tree);

} // namespace grandamp
