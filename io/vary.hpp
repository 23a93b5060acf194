// What a sweep varies: keys of a scene, each with its values, and the points of their grid. Internal to io.
#pragma once

#include "io/scene_file.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// One value of a varied key.
struct VaryValue {
  std::string text;             ///< as --set takes it
  std::optional<double> number; ///< none: a word or a list
};

struct VariedKey {
  std::string key;
  std::vector<VaryValue> values;
  bool numeric() const;
};

/// At most so many cases, points times seeds.
inline constexpr std::size_t most_cases = 100'000;

/// "KEY=START:STOP:COUNT", evenly spaced with both ends, "KEY=START:STOP:COUNT:log", by equal factors, or "KEY=a,b,c".
/// Keys that are whole numbers in a scene are rounded. Throws UsageError.
VariedKey parse_vary(const std::string& text);

/// All of them: no key twice, none that --set gives too, no grid that is too large. Throws UsageError.
std::vector<VariedKey> parse_vary(const std::vector<std::string>& texts, const std::vector<std::string>& overrides,
                                  std::size_t seeds);

/// Whether a scene wants a whole number there.
bool is_whole_key(const std::string& key);

/// A number as TOML, in the shortest form that reads back to the same bits.
std::string value_text(const std::string& key, double value);

/// The grid: the value of every key at every point, the last key the fastest.
std::vector<std::vector<VaryValue>> grid_points(const std::vector<VariedKey>& keys);

} // namespace grandamp
