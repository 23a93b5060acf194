// The files of io/report/ and the libraries of the page, as they were when the program was built. Internal to io.
#pragma once

#include <string_view>

namespace grandamp::report {

/// By the name that io/report/assets.cmake gives it; throws std::out_of_range if there is none of it.
std::string_view asset(std::string_view name);

} // namespace grandamp::report
