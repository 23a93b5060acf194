// Histories on a report's page: charts over one time axis, zoomed together. Internal to io.
#pragma once

#include "io/report_run.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace grandamp::report {

/// Colours that those who see red and green alike tell apart (Okabe and Ito's).
namespace colour {
inline constexpr const char* blue = "#0072b2";
inline constexpr const char* vermilion = "#d55e00";
inline constexpr const char* green = "#009e73";
inline constexpr const char* purple = "#cc79a7";
inline constexpr const char* orange = "#e69f00";
inline constexpr const char* sky = "#56b4e9";
inline constexpr const char* grey = "#5f6b76";
} // namespace colour

struct HistoryLine {
  std::string name;
  std::string colour;
  std::vector<double> values; ///< one per row, SI
};

struct HistoryChart {
  std::string name;     ///< of the picture
  std::string title;    ///< in words
  std::string quantity; ///< on the axis
  std::string unit;     ///< SI
  std::vector<HistoryLine> lines;
  std::array<double, 2> band{not_known, not_known}; ///< s, shaded
  bool stacked = false;                             ///< one upon the other
  std::string caption{};
};

/// All charts of a page share their rows, so that they are carried once.
class HistoryBook {
public:
  /// Rows that a page carries at most; more are thinned.
  static constexpr std::size_t most_rows = 200'000;

  explicit HistoryBook(std::vector<double> time);
  void add(Page& page, const HistoryChart& chart);
  /// The rows of all charts added; the last thing to be added.
  void close(Page& page);

private:
  std::vector<double> time_;
  std::vector<std::vector<double>> columns_;
};

} // namespace grandamp::report
