// Text for HTML and XML.
#pragma once

#include <string>
#include <string_view>

namespace grandamp {

/// Text as HTML and XML show it, in elements and in quoted attributes alike. Control characters are left out.
std::string escaped(std::string_view text);

} // namespace grandamp
