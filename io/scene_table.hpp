// A strict reader of one TOML table: every key is asked for by name and kind, and what nobody asked for is a fault.
// Internal to io; faults are collected, never thrown.
#pragma once

#include "io/granule_file.hpp"
#include "io/table_file.hpp"
#include "solver/errors.hpp"
#include "solver/scene.hpp"

#include <array>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <utility>
#include <vector>

namespace grandamp {

/// A number, an integer as the nearest of the doubles: toml++ itself gives none for one that is no double (above 2^53).
/// Null or no number: nothing.
std::optional<double> as_double(const toml::node* node);

/// What a key may hold, and how to say so.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true;
  bool high_included = true;

  bool holds(double value) const noexcept;
  std::string text() const;
};
constexpr double unbounded = std::numeric_limits<double>::infinity();
inline constexpr Range any_number{};
inline constexpr Range positive{0.0, unbounded, false, true};
inline constexpr Range not_negative{0.0, unbounded, true, true};

/// A fault, and what the treatment of overrides needs to know of it.
struct Finding {
  Problem problem;
  bool idle = false;       ///< the key does not apply to what the scene says
  bool unreadable = false; ///< a file that cannot be read
};

/// What the reading of one scene shares: where it is, what was overridden, what was found.
struct SceneReading {
  std::filesystem::path folder;                                            ///< files are relative to it
  std::map<std::string, std::string> overridden;                           ///< dotted key -> "KEY=VALUE"
  std::map<std::string, std::shared_ptr<const GranuleFile>> granule_files; ///< as read, by path
  std::map<std::string, std::shared_ptr<const TableFile>> table_files;     ///< likewise
  std::vector<Finding> findings;

  bool is_overridden(const std::string& key) const;
  /// The override that gave a key, or something in it; empty: none.
  std::string override_of(const std::string& key) const;
  void add(Finding finding);
};

/// A value as the scene has it, shortened where it is long.
std::string shown(const toml::node& node);

class TableReader {
public:
  /// `table` may be null: a table that the scene leaves out has no keys. `path`: its dotted key, empty for the root.
  TableReader(SceneReading& reading, const toml::table* table, std::string path);

  bool exists() const noexcept { return table_ != nullptr; }
  std::string key_path(std::string_view key) const;
  std::string header() const { return '[' + path_ + ']'; } ///< for messages
  SceneReading& reading() const noexcept { return *reading_; }

  /// Whether the scene has the key; does not count as asking for it.
  bool has(std::string_view key) const;

  std::optional<double> number(std::string_view key, const Range& range = any_number);
  /// A number, or one word; `said`: the word.
  std::optional<double> number_or_word(std::string_view key, const Range& range, std::string_view word, bool& said);
  std::optional<std::array<double, 2>> pair(std::string_view key); ///< two finite numbers
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t low, std::int64_t high);
  std::optional<bool> flag(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  std::optional<std::array<std::string, 2>> two_names(std::string_view key);
  std::optional<Vector3> vector(std::string_view key, const Range& each = any_number);
  std::optional<Vector3> direction(std::string_view key); ///< made a unit vector
  std::optional<std::vector<Vector3>> vectors(std::string_view key);
  const toml::table* table(std::string_view key); ///< null: left out, or no table (a fault)
  std::vector<const toml::table*> tables(std::string_view key);

  /// One of some words.
  template <class Enum>
  std::optional<Enum> choice(std::string_view key, std::initializer_list<std::pair<std::string_view, Enum>> words) {
    std::vector<std::string_view> allowed;
    for (const auto& word : words) allowed.push_back(word.first);
    const std::optional<std::size_t> index = word(key, allowed);
    if (!index) return std::nullopt;
    return (words.begin() + *index)->second;
  }

  /// Counts the key as asked for without reading it.
  void pass(std::string_view key) { asked_.emplace(key); }
  /// The key does not apply here: a fault if the scene has it.
  void idle(std::string_view key, const std::string& why, const std::string& allowed);
  /// Of keys that exclude each other, the one in force: an overridden one, otherwise the first that is there; the
  /// others are faults. Empty: none is there.
  std::string_view one_of(std::initializer_list<std::string_view> keys);
  void missing(std::string_view key, const std::string& why, const std::string& allowed);
  void wrong(std::string_view key, const std::string& message, const std::string& allowed);

  /// Every key that nobody asked for is a fault.
  void finish();

private:
  const toml::node* ask(std::string_view key);
  void wrong_type(std::string_view key, const std::string& allowed);
  std::optional<double> finite(const toml::node& node, std::string_view key, const Range& range,
                               const std::string& allowed);
  std::optional<Vector3> vector_of(const toml::node& node, std::string_view key, const Range& each,
                                   const std::string& item);
  std::optional<std::size_t> word(std::string_view key, const std::vector<std::string_view>& allowed);
  Finding finding(std::string_view key, const std::string& message, const std::string& allowed) const;

  SceneReading* reading_;
  const toml::table* table_;
  std::string path_;
  std::set<std::string, std::less<>> asked_;
};

} // namespace grandamp
