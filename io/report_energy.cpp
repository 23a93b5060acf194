// Where the energy went, how well the books balance, and what the search and the clock say.
#include "io/progress.hpp"
#include "io/report_data.hpp"
#include "io/report_histories.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp::report {
namespace {

struct Mechanism {
  const char* column;
  const char* name;
  const char* colour;
};
constexpr Mechanism losses[] = {{"structural_damping", "the structure's own damper", colour::grey},
                                {"normal_granule", "impacts between granules", colour::blue},
                                {"normal_wall", "impacts on the enclosure", colour::sky},
                                {"friction_granule", "friction between granules", colour::vermilion},
                                {"friction_wall", "friction on the enclosure", colour::orange}};
constexpr Mechanism stored[] = {{"structure", "structure", colour::blue},
                                {"kinetic", "granules, kinetic", colour::vermilion},
                                {"gravitational", "granules, height (change)", colour::green},
                                {"elastic", "contacts, elastic", colour::purple}};

/// What is left of the balance in every row, J.
std::vector<double> left_over(const RunFacts& run) {
  std::vector<double> left = *run.column("work_in");
  const auto take = [&left, &run](const char* name) {
    const std::vector<double>& values = *run.column(name);
    for (std::size_t k = 0; k < left.size(); ++k) left[k] -= values[k] - values.front();
  };
  for (const Mechanism& one : stored) take(one.column);
  for (const Mechanism& one : losses) take(one.column);
  return left;
}

/// What a residual is held against, as in the summary.
double scale_of(const RunFacts& run) {
  const double start =
      run.column("kinetic")->front() + run.column("elastic")->front() + run.column("structure")->front();
  double scale = std::max(std::abs(run.column("work_in")->back()), start);
  if (scale > 0.0) return scale;
  for (const Mechanism& one : losses) scale += run.column(one.column)->back();
  for (const Mechanism& one : stored)
    scale = std::max(scale, std::abs(run.column(one.column)->back() - run.column(one.column)->front()));
  return scale;
}

void add_shares(Page& page, const RunFacts& run) {
  double all = 0.0;
  for (const Mechanism& one : losses) all += run.column(one.column)->back();
  if (!(all > 0.0)) return;
  std::vector<std::vector<std::string>> rows;
  std::string bar;
  for (const Mechanism& one : losses) {
    const double value = run.column(one.column)->back(), share = 100.0 * value / all;
    rows.push_back({one.name, readable(value, "J"), fmt::format("{:.1f} %", share)});
    if (share > 0.0)
      bar += fmt::format("<span style=\"flex-grow:{:.4f};background:{}\" title=\"{}: {:.1f} %\"></span>", share,
                         one.colour, escaped(one.name), share);
  }
  rows.push_back({"all losses", readable(all, "J"), "100 %"});
  rows.push_back({"work of the excitation", readable(run.column("work_in")->back(), "J"), ""});
  page.add("<div class=\"shares\" aria-hidden=\"true\">" + bar + "</div>\n");
  page.add(table({"lost to", "energy", "share"}, rows));
}

} // namespace

void add_energy(Page& page, const RunFacts& run, HistoryBook& book) {
  page.section("energy", "Energy by mechanism");
  if (run.column("work_in") == nullptr) {
    page.add("<p>The ledger was off (output.energy = false): losses are not known.</p>\n");
    return;
  }
  add_shares(page, run);
  page.add("<div class=\"time-controls\" hidden></div>\n");
  HistoryChart lost{"losses", "Energy lost since the start, one mechanism upon the other", "energy", "J", {}};
  lost.stacked = true;
  for (const Mechanism& one : losses) {
    const std::vector<double>& values = *run.column(one.column);
    if (values.back() != 0.0) lost.lines.push_back({one.name, one.colour, values});
  }
  if (!lost.lines.empty()) book.add(page, lost);

  HistoryChart kept{"stored", "Energy stored", "energy", "J", {}};
  for (const Mechanism& one : stored) {
    std::vector<double> values = *run.column(one.column);
    if (one.column == std::string_view("gravitational")) {
      const double start = values.front();
      for (double& value : values) value -= start;
    }
    if (std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; }))
      kept.lines.push_back({one.name, one.colour, std::move(values)});
  }
  if (!kept.lines.empty()) book.add(page, kept);

  const double scale = scale_of(run);
  if (!(scale > 0.0)) return;
  std::vector<double> left = left_over(run);
  for (double& value : left) value *= 100.0 / scale;
  HistoryChart balance{"balance",
                       "What is left of the energy balance",
                       "left over, %",
                       "1",
                       {{"left over, %", colour::grey, std::move(left)}}};
  balance.caption =
      fmt::format("Initial energy and work put in, less what is stored and lost, over {}; the ideal is zero.",
                  readable(scale, "J"));
  book.add(page, balance);
}

void add_search_and_time(Page& page, const RunFacts& run) {
  if (run.summary.is_null()) return;
  const auto of = [&run](std::string_view path) { return number(run.summary, path); };
  page.section("search", "Search, guards and time");
  std::vector<std::vector<std::string>> rows{
      {"lists built", fmt::format("{:.0f}", of("verlet/builds"))},
      {"steps between builds, mean", fmt::format("{:.4g}", of("verlet/mean_interval"))},
      {"candidates per granule", fmt::format("{:.4g}", of("verlet/candidates_per_granule"))},
      {"contacts per granule", fmt::format("{:.4g}", of("verlet/contacts_per_granule"))},
      {"skin at the end", readable(of("verlet/skin"), "m")},
      {"steps compared with all pairs", fmt::format("{:.0f}", of("verlet/audited"))},
      {"contacts missed in them",
       of("verlet/audited") > 0.0 ? fmt::format("{:.0f}", of("verlet/missed")) : "not looked for"},
      {"deepest overlap, of a radius", fmt::format("{:.3g} %", 100.0 * of("guards/max_overlap"))},
      {"fastest granule", readable(of("guards/max_speed"), "m/s")},
      {"fastest closing of a contact", readable(of("guards/max_closing_speed"), "m/s")},
      {"the step rests on", readable(of("impact_speed"), "m/s")},
      {"granules escaped", fmt::format("{:.0f}", of("guards/escaped"))},
      {"wall time", readable_seconds(of("wall_time"))},
      {"poured before that in", readable_seconds(of("packing_wall_time"))},
      {"granule-steps per second", fmt::format("{:.3g} million", 1e-6 * of("granule_steps_per_second"))}};
  page.add(table({"quantity", "value"}, rows));
  const auto profile = run.summary.find("profile");
  if (profile == run.summary.end() || !profile->is_object()) return;
  Plot plot;
  plot.title = "Wall time by phase";
  plot.y = {.name = "s"};
  PlotSeries series{.colour = colour::blue};
  std::vector<std::vector<std::string>> phases;
  for (const auto& [phase, seconds] : profile->items()) {
    if (!seconds.is_number()) continue;
    const double value = seconds.get<double>(), share = 100.0 * value / of("wall_time");
    series.points.push_back(
        {.x = static_cast<double>(plot.categories.size()), .y = value, .label = fmt::format("{:.0f} %", share)});
    plot.categories.push_back(phase);
    phases.push_back({phase, fmt::format("{:.3g}", value), fmt::format("{:.1f} %", share)});
  }
  plot.series.push_back(std::move(series));
  page.add(figure_of(plot, "profile", "", table({"phase", "s", "of the wall time"}, phases)));
}

} // namespace grandamp::report
