// A small plot as SVG text: two logarithmic or linear axes, lines, areas, points, bars of error, labels. Internal to
// io.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// The room of a plot, in units of its SVG.
inline constexpr double plot_width = 640.0, plot_height = 420.0;

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
  bool area = false; ///< filled down to zero; series that follow are drawn over it
  double width = 1.5;
};

struct PlotAxis {
  std::string name{};
  bool logarithmic = false;
  bool from_zero = true; ///< a linear one shows zero
};

struct Plot {
  std::string title{};
  PlotAxis x{}, y{};
  std::vector<PlotSeries> series{};
  std::vector<std::string> categories{};       ///< bars instead: names along x, at x = 0, 1, ...
  std::optional<std::array<double, 2>> band{}; ///< of x, shaded
  bool legend_left = false;                    ///< where the right is taken

  /// A whole SVG document. Points that an axis cannot show (not finite, or not positive on a logarithmic one) are left
  /// out.
  std::string svg() const;
};

} // namespace grandamp
