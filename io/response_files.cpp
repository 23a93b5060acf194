#include "io/response_files.hpp"

#include "io/svg_grid.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <numbers>

namespace grandamp {
namespace {

double degrees(const std::complex<double>& value) {
  return std::arg(value) * 180.0 / std::numbers::pi;
}

/// A phase lag of half a turn lies at -180, with room about it.
double lag(const std::complex<double>& value) {
  const double angle = degrees(value);
  return angle > 90.0 ? angle - 360.0 : angle;
}

template <class Value>
PlotSeries curve(const FrequencyResponse& response, const char* label, const char* colour, const Value& value) {
  PlotSeries series{.name = label, .colour = colour, .line = true, .dots = false};
  for (std::size_t k = 0; k < response.spectra.frequency.size(); ++k)
    series.points.push_back({.x = response.spectra.frequency[k], .y = value(k)});
  return series;
}

/// A closed form has no lines: smooth, however far these are apart.
template <class Value>
PlotSeries closed_form(const FrequencyResponse& response, const char* label, const char* colour, const Value& value) {
  constexpr int points = 1000;
  PlotSeries series{.name = label, .colour = colour, .line = true, .dots = false};
  const double from = response.spectra.frequency.front(), to = response.spectra.frequency.back();
  for (int k = 0; k <= points; ++k) {
    const double frequency = from + (to - from) * k / points;
    series.points.push_back({.x = frequency, .y = value(frequency)});
  }
  return series;
}

PlotSeries magnitudes(const FrequencyResponse& response, const char* label, const char* colour) {
  PlotSeries series = curve(response, label, colour, [&](std::size_t k) { return std::abs(response.response[k]); });
  series.dots = series.points.size() <= 200;
  for (std::size_t k = 0; response.has_coherence() && k < series.points.size(); ++k) {
    const double error = std::min(response.spectra.random_error(k), 0.9);
    series.points[k].low = series.points[k].y * (1.0 - error);
    series.points[k].high = series.points[k].y * (1.0 + error);
  }
  return series;
}

constexpr const char* measured_colour = "#1f4e79";
constexpr const char* bare_colour = "#bdbdbd";
constexpr const char* added_colour = "#b3541e";

Plot panel(const char* quantity, bool logarithmic, bool from_zero) {
  Plot plot;
  plot.x = {.name = "frequency, Hz", .from_zero = false};
  plot.y = {.name = quantity, .logarithmic = logarithmic, .from_zero = from_zero};
  return plot;
}

} // namespace

std::string response_csv(const FrequencyResponse& response) {
  const Spectra& spectra = response.spectra;
  std::string text = "frequency,real,imaginary,magnitude,phase,coherence,random_error,force_psd,displacement_psd,"
                     "bare,added_mass\n";
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < spectra.frequency.size(); ++k) {
    const std::complex<double> h = response.response[k];
    fmt::format_to(std::back_inserter(text),
                   "{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n",
                   spectra.frequency[k], h.real(), h.imag(), std::abs(h), degrees(h),
                   response.has_coherence() ? spectra.coherence(k) : none,
                   response.has_coherence() ? spectra.random_error(k) : none, spectra.force[k], spectra.displacement[k],
                   std::abs(response.bare[k]), std::abs(response.added_mass[k]));
  }
  return text;
}

std::string response_svg(const FrequencyResponse& response, const std::string& title, bool granules) {
  const char* const measured = granules ? "with granules" : "of the run";
  Plot magnitude = panel("displacement over force, m/N", true, false);
  magnitude.title = title;
  const auto host = [&](Plot& plot, const auto& part) {
    plot.series.push_back(
        closed_form(response, "bare, closed form", bare_colour, [&](double f) { return part(response.host.bare(f)); }));
    plot.series.back().width = 4.0; // seen beneath a run without granules
    if (granules)
      plot.series.push_back(closed_form(response, "granules as added mass", added_colour,
                                        [&](double f) { return part(response.host.added_mass(f)); }));
  };
  host(magnitude, [](const std::complex<double>& h) { return std::abs(h); });
  magnitude.series.push_back(magnitudes(response, measured, measured_colour));

  Plot phase = panel("phase, degrees", false, true);
  phase.title = "Phase";
  host(phase, lag);
  phase.series.push_back(
      curve(response, measured, measured_colour, [&](std::size_t k) { return lag(response.response[k]); }));

  Plot density = panel("force, N^2/Hz", true, false);
  density.title = "Spectral density of the force";
  density.series.push_back(
      curve(response, "", measured_colour, [&](std::size_t k) { return response.spectra.force[k]; }));

  if (!response.has_coherence()) return grid_svg({magnitude, phase, density}, 2);
  Plot coherence = panel("coherence", false, true);
  coherence.title = fmt::format("Coherence of {} averages", response.spectra.segments);
  coherence.series.push_back(
      curve(response, "", measured_colour, [&](std::size_t k) { return response.spectra.coherence(k); }));
  return grid_svg({magnitude, phase, coherence, density}, 2);
}

} // namespace grandamp
