#include "io/study_report.hpp"
#include "io/svg_plot.hpp"
#include "io/text_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grandamp {

namespace {

constexpr const char* colours[][2] = {{"steps", "#1f4e79"},    {"integrator", "#b3541e"}, {"precision", "#2e7d32"},
                                      {"policy", "#7b1fa2"},   {"skin", "#00838f"},       {"friction", "#ad1457"},
                                      {"stiffness", "#9e9d24"}};

/// Beside a point of the ladder its steps are enough.
std::string short_label(const StudyRow& row) {
  if (row.setting->group == "steps" || row.setting->group == "integrator" || row.setting->group == "precision")
    return fmt::format("{:.3g}", row.setting->steps_per_contact);
  return row.setting->name;
}

PlotSeries own_mark(const StudyTable& table, double y, bool hollow = false) {
  PlotSeries series{.name = "the scene's own settings", .colour = "#d32f2f", .hollow = hollow};
  if (table.own != nullptr) series.points.push_back({.x = table.own->time, .y = y});
  return series;
}

Plot error_against_time(const StudyReport& report) {
  Plot plot;
  plot.title = "Error of a contact against time; numbers: steps in a contact";
  plot.x = {fmt::format("{} of a run, s", report.threads.each == 1 ? "processor time" : "wall time"), true};
  plot.y = {"error of a contact, %", true};
  PlotSeries best{.name = "frontier", .colour = "#9bb7d4", .line = true, .dots = false, .width = 5.0};
  for (const StudyRow* row : frontier(*report.table))
    best.points.push_back({.x = row->time, .y = 100.0 * row->setting->contact.error});
  plot.series.push_back(best);
  for (const auto& [group, colour] : colours) {
    if (group == std::string("friction") || group == std::string("stiffness")) continue; // other laws: other contacts
    PlotSeries series{.name = group, .colour = colour};
    series.line = group == std::string("steps") || group == std::string("integrator");
    for (const StudyRow& row : report.table->rows)
      if (row.setting->group == group && row.runs > 0)
        series.points.push_back({.x = row.time, .y = 100.0 * row.setting->contact.error, .label = short_label(row)});
    if (!series.points.empty()) plot.series.push_back(series);
  }
  if (report.table->own != nullptr)
    plot.series.push_back(own_mark(*report.table, 100.0 * report.table->own->setting->contact.error));
  return plot;
}

/// Whether the row differs from the reference by more than chance.
bool resolved(const StudyRow& row) {
  return std::any_of(row.differences.begin(), row.differences.end(),
                     [](const auto& one) { return is_main(one.observable) && one.resolved(); });
}

Plot response_against_time(const StudyReport& report) {
  Plot plot;
  plot.title = "Difference from the reference against time (hollow: not told from chance)";
  plot.x = {fmt::format("{} of a run, s", report.threads.each == 1 ? "processor time" : "wall time"), true};
  plot.y = {"largest of rms, amplitude and dissipation, %", true};
  for (const auto& [group, colour] : colours) {
    PlotSeries told{.name = group, .colour = colour}, hidden{.colour = colour, .hollow = true};
    for (const StudyRow& row : report.table->rows) {
      if (row.setting->group != group || row.runs == 0 || row.setting->reference || row.error() == 0.0) continue;
      const double error = 100.0 * row.error(), bar = 100.0 * row.scatter();
      (resolved(row) ? told : hidden)
          .points.push_back({row.time, error, std::max(error - bar, 0.01), error + bar, short_label(row)});
    }
    if (!told.points.empty() || !hidden.points.empty()) {
      plot.series.push_back(told);
      plot.series.push_back(hidden);
    }
  }
  if (report.table->own != nullptr && !report.table->own->setting->reference)
    plot.series.push_back(own_mark(*report.table, 100.0 * report.table->own->error(), !resolved(*report.table->own)));
  return plot;
}

Plot rate_against_step(const StudyReport& report) {
  Plot plot;
  plot.title = "Rate against step";
  plot.x = {"steps in a contact", true};
  plot.y = {"million granule-steps per second", false};
  for (const auto& [group, colour] : colours) {
    if (group != std::string("steps") && group != std::string("integrator") && group != std::string("precision"))
      continue;
    PlotSeries series{.name = group == std::string("steps") ? "leapfrog" : group, .colour = colour, .line = true};
    for (const StudyRow& row : report.table->rows)
      if (row.setting->group == group && row.runs > 0)
        series.points.push_back({.x = row.setting->steps_per_contact, .y = 1e-6 * row.rate});
    if (!series.points.empty()) plot.series.push_back(series);
  }
  return plot;
}

Plot missed_by_policy(const StudyReport& report) {
  Plot plot;
  plot.title = "Contacts that began unlisted, by list policy";
  plot.y = {"missed contacts", false};
  PlotSeries series{.colour = "#7b1fa2"};
  for (const StudyRow& row : report.table->rows) {
    if (!row.audited) continue;
    std::string name = row.setting->own ? "own" : row.setting->name;
    if (name.starts_with("policy-")) name = name.substr(7);
    plot.x.name = fmt::format("compared with all pairs over {:.3g} s", row.audited_time);
    series.points.push_back({.x = static_cast<double>(plot.categories.size()),
                             .y = static_cast<double>(row.missed),
                             .label = fmt::format("{}", row.missed)});
    plot.categories.push_back(name);
  }
  plot.series.push_back(series);
  return plot;
}

} // namespace

void write_study_pictures(const StudyReport& report, const std::filesystem::path& folder) {
  replace_file(folder / "error_time.svg", error_against_time(report).svg());
  replace_file(folder / "response_time.svg", response_against_time(report).svg());
  replace_file(folder / "rate_step.svg", rate_against_step(report).svg());
  replace_file(folder / "missed_policy.svg", missed_by_policy(report).svg());
}

} // namespace grandamp
