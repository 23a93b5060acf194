// Several plots in one picture. Internal to io.
#pragma once

#include "io/svg_plot.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace grandamp {

/// A whole SVG document of the plots, row by row.
std::string grid_svg(const std::vector<Plot>& plots, std::size_t columns);

} // namespace grandamp
