#include "io/svg_plot.hpp"

#include "io/markup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace grandamp {

namespace {

constexpr double left = 72.0, right = 20.0, top = 36.0, bottom = 52.0;

/// Values to places along one side of the frame.
class Scale {
public:
  Scale(const PlotAxis& axis, double from, double to)
      : logarithmic_(axis.logarithmic), from_zero_(axis.from_zero), from_(from), to_(to) {}

  bool shows(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0.0); }
  void include(double value) {
    if (!shows(value)) return;
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  void close() {
    if (!(low_ <= high_)) low_ = high_ = 1.0;
    if (logarithmic_) {
      low_ = std::pow(10.0, std::floor(std::log10(low_) * 2.0 + 1e-9) / 2.0) * 0.95;
      high_ = std::pow(10.0, std::ceil(std::log10(high_) * 2.0 - 1e-9) / 2.0) * 1.05;
    } else {
      if (from_zero_) low_ = std::min(0.0, low_);
      const double room = high_ > low_ ? 0.08 * (high_ - low_) : std::max(std::abs(low_), 1.0);
      high_ += room;
      if (low_ < 0.0 || !from_zero_) low_ -= room;
    }
  }
  double at(double value) const {
    const double clamped = std::clamp(value, low_, high_);
    const double share =
        logarithmic_ ? std::log(clamped / low_) / std::log(high_ / low_) : (clamped - low_) / (high_ - low_);
    return from_ + share * (to_ - from_);
  }
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    if (logarithmic_) {
      for (double decade = std::pow(10.0, std::floor(std::log10(low_))); decade <= high_; decade *= 10.0)
        for (const double step : {1.0, 2.0, 5.0})
          if (decade * step >= low_ && decade * step <= high_) ticks.push_back(decade * step);
      return ticks;
    }
    const double raw = (high_ - low_) / 5.0, decade = std::pow(10.0, std::floor(std::log10(raw)));
    const double step = raw / decade < 1.5 ? decade : raw / decade < 3.5 ? 2.0 * decade : 5.0 * decade;
    for (double tick = std::ceil(low_ / step) * step; tick <= high_; tick += step)
      ticks.push_back(std::abs(tick) < 1e-9 * step ? 0.0 : tick); // a sum that misses 0 is not -0
    return ticks;
  }

private:
  bool logarithmic_, from_zero_;
  double from_, to_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

class Drawing {
public:
  Drawing(const Plot& plot) : plot_(plot), x_(plot.x, left, plot_width - right), y_(plot.y, plot_height - bottom, top) {
    for (const PlotSeries& series : plot.series)
      for (const PlotPoint& point : series.points) {
        if (!shown(point)) continue;
        x_.include(point.x);
        y_.include(point.y);
        if (point.high > point.low) y_.include(point.high);
        if (point.high > point.low && !plot.y.logarithmic) y_.include(point.low);
      }
    if (!plot.categories.empty()) {
      x_.include(-0.6);
      x_.include(static_cast<double>(plot.categories.size()) - 0.4);
    }
    if (plot.categories.empty()) x_.close();
    y_.close();
  }

  std::string text() {
    out_ =
        fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:g} {1:g}" width="{0:g}" height="{1:g}" )"
                    R"(font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="white"/>)",
                    plot_width, plot_height);
    write(0.5 * plot_width, 20.0, plot_.title, R"(text-anchor="middle" font-size="13")");
    frame();
    for (const PlotSeries& series : plot_.series) draw(series);
    legend();
    return out_ + "</svg>\n";
  }

private:
  bool shown(const PlotPoint& point) const { return x_.shows(point.x) && y_.shows(point.y); }

  void write(double x, double y, const std::string& text, const std::string& attributes) {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, escaped(text));
  }
  void line(double x0, double y0, double x1, double y1, const char* colour, double thickness) {
    out_ += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"{:g}\"/>\n", x0, y0, x1,
                        y1, colour, thickness);
  }

  /// Over the lines, on a ground that they only shine through.
  void legend() {
    std::size_t rows = 0, longest = 0;
    for (const PlotSeries& series : plot_.series) {
      if (series.name.empty()) continue;
      ++rows;
      longest = std::max(longest, series.name.size());
    }
    if (rows == 0) return;
    const double reach = 30.0 + 5.8 * static_cast<double>(longest);
    const bool to_left = plot_.legend_left;
    out_ +=
        fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="white" fill-opacity="0.8"/>)",
                    to_left ? left + 1.0 : plot_width - right - reach, top + 1.0, reach - 1.0,
                    15.0 * static_cast<double>(rows) + 6.0);
    double y = top + 14.0;
    for (const PlotSeries& series : plot_.series) {
      if (series.name.empty()) continue;
      mark(to_left ? left + 12.0 : plot_width - right - 12.0, y - 4.0, series);
      write(to_left ? left + 22.0 : plot_width - right - 22.0, y, series.name,
            to_left ? R"(text-anchor="start")" : R"(text-anchor="end")");
      y += 15.0;
    }
  }

  void frame() {
    if (plot_.band) {
      const double from = x_.at((*plot_.band)[0]), to = x_.at((*plot_.band)[1]);
      out_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#eef3f8\"/>\n",
                          from, top, to - from, plot_height - top - bottom);
    }
    for (const double tick : y_.ticks()) {
      line(left, y_.at(tick), plot_width - right, y_.at(tick), "#dddddd", 0.7);
      write(left - 6.0, y_.at(tick) + 4.0, fmt::format("{:g}", tick), R"(text-anchor="end")");
    }
    if (plot_.categories.empty())
      for (const double tick : x_.ticks()) {
        line(x_.at(tick), top, x_.at(tick), plot_height - bottom, "#dddddd", 0.7);
        write(x_.at(tick), plot_height - bottom + 16.0, fmt::format("{:g}", tick), R"(text-anchor="middle")");
      }
    for (std::size_t k = 0; k < plot_.categories.size(); ++k)
      write(place(k), plot_height - bottom + 16.0, plot_.categories[k], R"(text-anchor="middle")");
    out_ +=
        fmt::format("<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"none\" stroke=\"#666666\"/>\n",
                    left, top, plot_width - left - right, plot_height - top - bottom);
    write(0.5 * (left + plot_width - right), plot_height - 14.0, plot_.x.name, R"(text-anchor="middle")");
    out_ += fmt::format("<text transform=\"translate(16 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                        0.5 * (top + plot_height - bottom), escaped(plot_.y.name));
  }

  /// The middle of the bar of that number.
  double place(std::size_t k) const {
    const double share = (plot_width - left - right) / static_cast<double>(plot_.categories.size());
    return left + share * (static_cast<double>(k) + 0.5);
  }

  void mark(double x, double y, const PlotSeries& series) {
    out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\" stroke=\"{}\"/>\n", x, y,
                        series.hollow ? "white" : series.colour, series.colour);
  }

  void draw(const PlotSeries& series) {
    if (!plot_.categories.empty()) return bars(series);
    if (series.line || series.area) {
      std::string path;
      for (const PlotPoint& point : series.points)
        if (shown(point))
          path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x_.at(point.x), y_.at(point.y));
      if (series.area && !path.empty())
        out_ += fmt::format("<path d=\"{}V{:.1f}H{:.1f}Z\" fill=\"{}\"/>\n", path, y_.at(0.0),
                            x_.at(series.points.front().x), series.colour);
      else
        out_ += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" "
                            "stroke-linejoin=\"round\"/>\n",
                            path, series.colour, series.width);
    }
    for (const PlotPoint& point : series.points) {
      if (!shown(point)) continue;
      const double x = x_.at(point.x), y = y_.at(point.y);
      if (point.high > point.low) line(x, y_.at(point.low), x, y_.at(point.high), series.colour.c_str(), 0.8);
      if (series.dots) mark(x, y, series);
      if (!point.label.empty()) label(x, y - 5.0, point.label);
    }
  }

  /// Right of x, or left of it where the picture ends; left out where it would lie on another one.
  void label(double at, double y, const std::string& text) {
    const double reach = 5.0 * static_cast<double>(text.size());
    const double x = at + 6.0 + reach < plot_width - right ? at + 6.0 : at - 6.0 - reach;
    for (const auto& [left_end, right_end, height_there] : labels_)
      if (x < right_end && left_end < x + reach && std::abs(y - height_there) < 9.0) return;
    labels_.push_back({x, x + reach, y});
    write(x, y, text, R"(font-size="9" fill="#444444")");
  }

  void bars(const PlotSeries& series) {
    const double half = 0.3 * (plot_width - left - right) / static_cast<double>(plot_.categories.size());
    for (std::size_t k = 0; k < series.points.size(); ++k) {
      const PlotPoint& point = series.points[k];
      const double y = y_.at(point.y);
      out_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                          place(k) - half, y, 2.0 * half, plot_height - bottom - y, series.colour);
      if (point.high > point.low) line(place(k), y_.at(point.low), place(k), y_.at(point.high), "#222222", 1.2);
      write(place(k), y - 5.0, point.label, R"(text-anchor="middle")");
    }
  }

  const Plot& plot_;
  Scale x_, y_;
  std::string out_;
  std::vector<std::array<double, 3>> labels_; ///< from x, to x, y
};

} // namespace

std::string Plot::svg() const {
  return Drawing(*this).text();
}

} // namespace grandamp
