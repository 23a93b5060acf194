#include "io/report_histories.hpp"
#include "io/json.hpp"
#include "io/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp::report {
namespace {

constexpr std::size_t rows_of_a_picture = 1400;

double largest_of(const std::vector<HistoryLine>& lines) {
  double largest = 0.0;
  for (const HistoryLine& line : lines)
    for (const double value : line.values) largest = std::max(largest, std::abs(value));
  return largest;
}

Plot still_plot(const std::vector<double>& time, const HistoryChart& chart, const ReadableUnit& unit) {
  Plot plot;
  plot.title = chart.title;
  plot.x = {.name = "time, s"};
  plot.y = {.name = unit.name.empty() ? chart.quantity : chart.quantity + ", " + unit.name, .from_zero = chart.stacked};
  if (std::isfinite(chart.band[0])) plot.band = chart.band;
  // Stacked from the last upwards, so that the first is on top, as its name is.
  std::vector<HistoryLine> lines = chart.lines;
  if (chart.stacked) std::reverse(lines.begin(), lines.end());
  Rows rows{time, {}};
  for (HistoryLine& line : lines) {
    if (chart.stacked && !rows.columns.empty())
      for (std::size_t k = 0; k < line.values.size(); ++k) line.values[k] += rows.columns.back()[k];
    rows.columns.push_back(std::move(line.values));
  }
  const Rows thin = thinned(rows, rows_of_a_picture);
  for (std::size_t c = 0; c < lines.size(); ++c) {
    PlotSeries series{.name = lines.size() > 1 ? lines[c].name : "",
                      .colour = lines[c].colour,
                      .line = true,
                      .dots = false,
                      .area = chart.stacked,
                      .width = 1.0};
    for (std::size_t k = 0; k < thin.time.size(); ++k)
      series.points.push_back({.x = thin.time[k], .y = thin.columns[c][k] * unit.factor});
    plot.series.push_back(std::move(series));
  }
  if (chart.stacked) std::reverse(plot.series.begin(), plot.series.end()); // the highest sum first, the others over it
  plot.legend_left = chart.stacked;
  return plot;
}

std::string numbers_of(const std::vector<double>& time, const HistoryChart& chart, const ReadableUnit& unit) {
  std::vector<std::vector<std::string>> rows;
  for (const HistoryLine& line : chart.lines) {
    double low = line.values.front(), high = low, sum = 0.0, squares = 0.0;
    for (const double value : line.values) {
      low = std::min(low, value);
      high = std::max(high, value);
      sum += value;
      squares += value * value;
    }
    const auto count = static_cast<double>(line.values.size());
    const auto show = [&unit](double value) { return fmt::format("{:.4g}", value * unit.factor); };
    rows.push_back({line.name, show(low), show(high), show(sum / count), show(std::sqrt(squares / count)),
                    show(line.values.front()), show(line.values.back())});
  }
  return table(
      {unit.name.empty() ? "quantity" : "quantity, " + unit.name, "least", "greatest", "mean", "rms", "first", "last"},
      rows, fmt::format("{} rows, {:.6g} to {:.6g} s", time.size(), time.front(), time.back()));
}

} // namespace

HistoryBook::HistoryBook(std::vector<double> time) : time_(std::move(time)) {}

void HistoryBook::add(Page& page, const HistoryChart& chart) {
  const ReadableUnit unit = readable_unit(largest_of(chart.lines), chart.unit);
  Json live{{"kind", "history"},
            {"quantity", unit.name.empty() ? chart.quantity : chart.quantity + ", " + unit.name},
            {"unit", unit.name},
            {"factor", unit.factor},
            {"stacked", chart.stacked}};
  if (std::isfinite(chart.band[0])) live["band"] = chart.band;
  live["lines"] = Json::array();
  for (const HistoryLine& line : chart.lines) {
    live["lines"].push_back({{"name", line.name}, {"colour", line.colour}, {"column", columns_.size()}});
    columns_.push_back(line.values);
  }
  page.add(Figure{chart.name, chart.title, chart.caption, still_plot(time_, chart, unit).svg(), std::move(live),
                  numbers_of(time_, chart, unit)});
}

void HistoryBook::close(Page& page) {
  if (columns_.empty()) return;
  const std::size_t rows = time_.size();
  const Rows thin = thinned({std::move(time_), std::move(columns_)}, most_rows);
  if (thin.time.size() < rows)
    page.add(fmt::format(
        "<p class=\"note\">Of {} rows this page holds, for every {:.3g} of them, the least and the greatest "
        "value of each quantity; `grandamp export` writes them all.</p>\n",
        rows, 2.0 * static_cast<double>(rows) / static_cast<double>(thin.time.size())));
  std::vector<float> values;
  values.reserve(thin.columns.size() * thin.time.size());
  for (const std::vector<double>& column : thin.columns)
    for (const double value : column) values.push_back(static_cast<float>(value));
  page.add_data("time", bytes_of(thin.time));
  page.add_data("histories", bytes_of(values));
  page.facts()["histories"] = {{"rows", thin.time.size()}, {"columns", thin.columns.size()}};
}

} // namespace grandamp::report
