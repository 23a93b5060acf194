// How the structure moves: its histories, and the amplitude cycle by cycle.
#include "io/json.hpp"
#include "io/report_data.hpp"
#include "io/report_histories.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace grandamp::report {
namespace {

/// Of rows first to last, one past: half the peak-to-peak.
double half_swing(const std::vector<double>& values, std::size_t first, std::size_t last) {
  const auto [low, high] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                                               values.begin() + static_cast<std::ptrdiff_t>(last));
  return 0.5 * (*high - *low);
}

/// Whole periods from `start` on, before and after.
std::vector<Cycle> periods(const std::vector<double>& time, const std::vector<double>& x, double start, double period) {
  std::vector<Cycle> cycles;
  const double slack = 1e-6 * period;
  std::size_t first = 0;
  for (double begin = start - std::floor(start / period + 1e-6) * period; begin + period <= time.back() + slack;
       begin += period) {
    while (first < time.size() && time[first] < begin - slack) ++first;
    std::size_t last = first;
    while (last < time.size() && time[last] <= begin + period + slack) ++last;
    if (last > first) cycles.push_back({begin, begin + period, half_swing(x, first, last)});
  }
  return cycles;
}

/// From one crossing of zero upwards to the next.
std::vector<Cycle> crossings(const std::vector<double>& time, const std::vector<double>& x) {
  std::vector<Cycle> cycles;
  std::optional<std::size_t> first;
  for (std::size_t k = 1; k < x.size(); ++k) {
    if (!(x[k - 1] < 0.0 && x[k] >= 0.0)) continue;
    if (first) cycles.push_back({time[*first], time[k], half_swing(x, *first, k)});
    first = k;
  }
  return cycles;
}

const Json* told_cycles(const RunFacts& run) {
  if (!run.summary.is_object() || !run.summary.contains("structure")) return nullptr;
  const auto found = run.summary["structure"].find("cycles");
  return found != run.summary["structure"].end() && found->is_array() && !found->empty() ? &*found : nullptr;
}

void add_damping(Page& page, const Json& cycles) {
  Plot plot;
  plot.title = "Damping ratio against amplitude, cycle by cycle";
  double largest = 0.0;
  for (const Json& cycle : cycles) largest = std::max(largest, number(cycle, "amplitude"));
  const ReadableUnit unit = readable_unit(largest, "m");
  plot.x = {.name = "amplitude, " + unit.name};
  plot.y = {.name = "equivalent viscous damping ratio, %"};
  PlotSeries series{.colour = colour::blue, .line = true};
  std::vector<std::vector<std::string>> rows;
  for (const Json& cycle : cycles) {
    const double amplitude = number(cycle, "amplitude") * unit.factor, ratio = 100.0 * number(cycle, "damping_ratio");
    if (!std::isfinite(amplitude) || !std::isfinite(ratio)) continue;
    series.points.push_back({.x = amplitude, .y = ratio});
    rows.push_back({fmt::format("{:.5g}", number(cycle, "start")), fmt::format("{:.4g}", amplitude),
                    fmt::format("{:.3g}", ratio), fmt::format("{:.3g}", number(cycle, "specific_damping_capacity"))});
  }
  if (series.points.empty()) return;
  plot.series.push_back(std::move(series));
  page.add(figure_of(
      plot, "damping_amplitude",
      "Of the viscous damping that would take as much energy in that cycle; it depends on the amplitude, as that of "
      "granules does.",
      table({"cycle from, s", "amplitude, " + unit.name, "damping ratio, %", "specific damping capacity"}, rows)));
}

} // namespace

std::vector<Cycle> cycles_of(const RunFacts& run) {
  if (const Json* told = told_cycles(run)) {
    std::vector<Cycle> cycles;
    for (const Json& cycle : *told) cycles.push_back({number(cycle, "start"), not_known, number(cycle, "amplitude")});
    for (std::size_t k = 0; k + 1 < cycles.size(); ++k) cycles[k].end = cycles[k + 1].start;
    return cycles;
  }
  const std::vector<double>&time = *run.column("time"), &x = *run.column("displacement");
  const double frequency = run.forcing_frequency();
  if (!std::isfinite(frequency)) return crossings(time, x);
  return periods(time, x, std::isfinite(run.window()[0]) ? run.window()[0] : 0.0, 1.0 / frequency);
}

void add_histories(Page& page, const RunFacts& run, HistoryBook& book) {
  struct Wanted {
    const char* name;
    const char* title;
    const char* unit;
    const char* colour;
  };
  static constexpr Wanted wanted[] = {{"displacement", "Displacement of the enclosure", "m", colour::blue},
                                      {"velocity", "Velocity of the enclosure", "m/s", colour::green},
                                      {"excitation", "Excitation", "N", colour::vermilion},
                                      {"reaction", "Force of the granules on the enclosure", "N", colour::purple},
                                      {"contacts", "Contacts", "1", colour::grey}};
  page.section("histories", "Histories");
  page.add("<div class=\"time-controls\" hidden></div>\n");
  std::string nothing;
  for (const Wanted& one : wanted) {
    const std::vector<double>* values = run.column(one.name);
    if (values == nullptr) continue;
    if (std::all_of(values->begin(), values->end(), [](double value) { return value == 0.0; })) {
      nothing += (nothing.empty() ? "" : ", ") + std::string(one.name);
      continue;
    }
    HistoryChart chart{one.name, one.title, one.name, one.unit, {{one.name, one.colour, *values}}};
    chart.band = run.window();
    book.add(page, chart);
  }
  if (!nothing.empty())
    page.add(fmt::format("<p class=\"note\">Zero throughout, and not drawn: {}.</p>\n", escaped(nothing)));
}

void add_amplitudes(Page& page, const RunFacts& run) {
  if (run.scene && !run.scene->structure) return;
  const std::vector<Cycle> cycles = cycles_of(run);
  if (cycles.size() < 2) return;
  double largest = 0.0;
  for (const Cycle& cycle : cycles) largest = std::max(largest, cycle.amplitude);
  const ReadableUnit unit = readable_unit(largest, "m");
  Plot plot;
  plot.title = "Amplitude, cycle by cycle";
  plot.x = {.name = "time, s"};
  plot.y = {.name = "half the peak-to-peak, " + unit.name};
  if (std::isfinite(run.window()[0])) plot.band = run.window();
  PlotSeries series{.name = "each cycle", .colour = colour::blue, .line = true};
  std::vector<std::vector<std::string>> rows;
  for (const Cycle& cycle : cycles) {
    series.points.push_back({.x = cycle.start, .y = cycle.amplitude * unit.factor});
    rows.push_back({fmt::format("{:.5g}", cycle.start), fmt::format("{:.4g}", cycle.amplitude * unit.factor)});
  }
  plot.series.push_back(std::move(series));
  const double mean = number(run.summary, "structure/amplitude");
  const bool forced = told_cycles(run) == nullptr && std::isfinite(mean);
  if (forced) {
    PlotSeries line{
        .name = "mean of the window", .colour = colour::vermilion, .line = true, .dots = false, .width = 2.0};
    for (const double at : run.window()) line.points.push_back({.x = at, .y = mean * unit.factor});
    plot.series.push_back(std::move(line));
  }
  page.section("amplitude", "Amplitude per cycle");
  page.add(figure_of(plot, "amplitude",
                     plot.band ? "Shaded: the window of the statistics. From the rows of the histories." : "",
                     table({"cycle from, s", "amplitude, " + unit.name}, rows)));
  if (const Json* told = told_cycles(run)) add_damping(page, *told);
}

} // namespace grandamp::report
