// What an optimiser may choose: scene keys between bounds, and points of the unit cube that stand for them.
// Internal to io.
#pragma once

#include "io/vary.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

struct FreeKey {
  std::string key;
  double low = 0.0, high = 1.0;
  bool logarithmic = false; ///< equal factors are equal ways

  double at(double share) const;       ///< 0 at low, 1 at high
  double share_of(double value) const; ///< the inverse
};

/// "KEY=A:B" or "KEY=A:B:log". Throws UsageError.
FreeKey parse_over(const std::string& text);
/// All of them: no key twice, none that --set gives too. Throws UsageError.
std::vector<FreeKey> parse_over(const std::vector<std::string>& texts, const std::vector<std::string>& overrides);

/// The values at a point of the unit cube; whole numbers rounded.
std::vector<VaryValue> values_at(const std::vector<FreeKey>& keys, const std::vector<double>& point);

/// The number that the text of a scene gives a dotted key; nothing where it gives none.
std::optional<double> number_in(const std::string& scene_text, const std::string& key);

/// Points that fill the unit cube evenly however many are taken: Halton's, from bases 2, 3, 5, ...
std::vector<double> halton_point(std::size_t index, std::size_t dimensions);

} // namespace grandamp
