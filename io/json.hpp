// JSON as the program writes and reads it: keys keep their order. Internal to io.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace grandamp {

using Json = nlohmann::ordered_json;

/// A number; null where it is not finite, for which JSON has no word.
inline Json json_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

} // namespace grandamp
