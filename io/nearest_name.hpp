// "Did you mean": the known name nearest to one that is not known.
#pragma once

#include <span>
#include <string_view>

namespace grandamp {

/// The nearest by edit distance, if it is near enough to be meant; otherwise empty.
std::string_view nearest_name(std::string_view unknown, std::span<const std::string_view> known);

} // namespace grandamp
