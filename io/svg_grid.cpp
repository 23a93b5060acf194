#include "io/svg_grid.hpp"

#include <fmt/format.h>

namespace grandamp {

std::string grid_svg(const std::vector<Plot>& plots, std::size_t columns) {
  const std::size_t rows = (plots.size() + columns - 1) / columns;
  std::string text =
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:g} {1:g}" width="{0:g}" height="{1:g}">)"
                  R"(<rect width="100%" height="100%" fill="white"/>)",
                  plot_width * static_cast<double>(columns), plot_height * static_cast<double>(rows));
  for (std::size_t k = 0; k < plots.size(); ++k) {
    const std::string plot = plots[k].svg(); // begins with its own <svg
    const std::size_t row = k / columns;
    text += fmt::format("<svg x=\"{:g}\" y=\"{:g}\"{}", plot_width * static_cast<double>(k % columns),
                        plot_height * static_cast<double>(row), plot.substr(plot.find("<svg") + 4));
  }
  return text + "</svg>\n";
}

} // namespace grandamp
