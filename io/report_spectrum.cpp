// The frequency response that a run of many frequencies left in response.csv.
#include "io/report_data.hpp"
#include "io/report_files.hpp"
#include "io/report_histories.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp::report {
namespace {

struct Curve {
  const char* column;
  const char* name;
  const char* colour;
  double width;
};

PlotSeries series_of(const CsvColumns& csv, const std::vector<double>& frequency, const Curve& curve, double factor) {
  PlotSeries series{.name = curve.name, .colour = curve.colour, .line = true, .dots = false, .width = curve.width};
  const std::vector<double>* values = csv.find(curve.column);
  if (values == nullptr) return series;
  for (std::size_t k = 0; k < frequency.size(); ++k)
    if (std::isfinite((*values)[k])) series.points.push_back({.x = frequency[k], .y = (*values)[k] * factor});
  return series;
}

void add_plot(Page& page, const CsvColumns& csv, const std::vector<double>& frequency, const char* name,
              const char* title, const std::string& axis, bool logarithmic, double factor,
              std::initializer_list<Curve> curves, const std::string& caption) {
  Plot plot;
  plot.title = title;
  plot.x = {.name = "frequency, Hz", .from_zero = false};
  plot.y = {.name = axis, .logarithmic = logarithmic, .from_zero = false};
  for (const Curve& curve : curves)
    if (PlotSeries series = series_of(csv, frequency, curve, factor); !series.points.empty())
      plot.series.push_back(std::move(series));
  if (!plot.series.empty()) page.add(figure_of(plot, name, caption, ""));
}

} // namespace

void add_spectrum(Page& page, const RunFacts& run) {
  const std::string message = text(run.summary, "response/message");
  const std::filesystem::path file = run.folder / "response.csv";
  std::error_code ignored;
  const bool there = std::filesystem::exists(file, ignored);
  if (!there && message.empty()) return;
  page.section("response", "Frequency response");
  if (!there) {
    page.add("<p>" + escaped(message) + "</p>\n");
    return;
  }
  const CsvColumns csv = read_csv(file);
  const std::vector<double>* frequency = csv.find("frequency");
  const auto of = [&run](std::string_view path) { return number(run.summary, path); };
  if (frequency == nullptr || csv.find("magnitude") == nullptr) return;
  const auto shown = [](double value, const char* form) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : std::string();
  };
  page.add(facts({{"Method", text(run.summary, "response/method")},
                  {"Averages", shown(of("response/averages"), "{:.0f}")},
                  {"Between lines", shown(of("response/resolution"), "{:.4g} Hz")},
                  {"Peak", std::isfinite(of("response/peak_frequency"))
                               ? fmt::format("{} at {:.5g} Hz", readable(of("response/peak_magnitude"), "m/N"),
                                             of("response/peak_frequency"))
                               : ""},
                  {"Natural frequency, fitted", shown(of("response/fit/natural_frequency"), "{:.5g} Hz")},
                  {"Damping ratio, fitted", shown(100.0 * of("response/fit/damping_ratio"), "{:.3g} %")},
                  {"Coherence around the peak", shown(of("response/mean_coherence"), "{:.3g}")},
                  {"Random error of the magnitude", shown(100.0 * of("response/random_error"), "{:.2g} %")}}));
  if (of("response/mean_coherence") < 0.9)
    page.add("<p class=\"flag\">The coherence around the peak is below 0.9: much of the motion there is not the "
             "force's doing alone (granules are "
             "not linear), and the response is an average that depends on the force.</p>\n");
  if (run.summary.contains("response") && run.summary["response"].contains("notes"))
    for (const auto& note : run.summary["response"]["notes"])
      if (note.is_string()) page.add("<p class=\"note\">" + escaped(note.get<std::string>()) + "</p>\n");
  double largest = 0.0;
  for (const double value : *csv.find("magnitude"))
    if (std::isfinite(value)) largest = std::max(largest, value);
  const ReadableUnit unit = readable_unit(largest, "m/N");
  add_plot(page, csv, *frequency, "response_magnitude", "Displacement over force", unit.name, true, unit.factor,
           {{"bare", "bare structure, closed form", colour::grey, 2.0},
            {"added_mass", "granules as added mass", colour::orange, 2.0},
            {"magnitude", "H1", colour::blue, 1.5}},
           "");
  add_plot(page, csv, *frequency, "response_phase", "Phase of displacement over force", "degrees", false, 1.0,
           {{"phase", "", colour::blue, 1.5}}, "");
  add_plot(page, csv, *frequency, "coherence", "Coherence", "1", false, 1.0, {{"coherence", "", colour::green, 1.5}},
           "1: all of the displacement follows from the force.");
}

} // namespace grandamp::report
