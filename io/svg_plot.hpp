// A small plot as SVG text: two logarithmic or linear axes, lines, points, bars of error, labels. Internal to io.
#pragma once

#include <string>
#include <vector>

namespace grandamp {

struct PlotPoint {
  double x = 0.0, y = 0.0;
  double low = 0.0, high = 0.0; ///< bar of error, if high > low
  std::string label{};          ///< beside the point; empty: none
};

struct PlotSeries {
  std::string name{}; ///< in the legend; empty: not there
  std::string colour = "#1f4e79";
  std::vector<PlotPoint> points{};
  bool line = false;
  bool dots = true;
  bool hollow = false;
  double width = 1.5;
};

struct PlotAxis {
  std::string name;
  bool logarithmic = false;
  bool from_zero = true; ///< a linear axis begins at 0 unless values are below it; else at the least value
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotSeries> series;
  std::vector<std::string> categories; ///< bars instead: names along x, at x = 0, 1, ...

  /// A whole SVG document. Points that an axis cannot show (not finite, or not positive on a logarithmic one) are left
  /// out.
  std::string svg() const;
};

} // namespace grandamp
