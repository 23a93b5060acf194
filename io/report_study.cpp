#include "io/report_study.hpp"

#include "io/json.hpp"
#include "io/report_files.hpp"
#include "io/report_histories.hpp"
#include "io/study_statistics.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace grandamp::report {
namespace {

struct Group {
  const char* name;
  const char* colour;
};
constexpr std::array groups{Group{"steps", colour::blue},      Group{"integrator", colour::vermilion},
                            Group{"precision", colour::green}, Group{"policy", colour::purple},
                            Group{"skin", colour::sky},        Group{"friction", colour::orange},
                            Group{"stiffness", colour::grey}};

bool was_run(const Json& setting) {
  return number(setting, "runs") > 0.0;
}

std::string beside(const Json& setting) {
  const std::string group = text(setting, "group");
  return group == "steps" || group == "integrator" || group == "precision"
             ? fmt::format("{:.3g}", number(setting, "steps_per_contact"))
             : text(setting, "name");
}

/// The largest difference of a main observable from the reference, with its bar of three standard errors.
struct Difference {
  double size = 0.0, bar = 0.0;
  bool resolved = false;
};
Difference largest_difference(const Json& setting) {
  Difference largest;
  if (!setting.contains("observables")) return largest;
  for (const auto& [name, one] : setting["observables"].items()) {
    if (!is_main(name)) continue;
    const double size = std::abs(number(one, "difference"));
    if (size > largest.size) largest = {size, 3.0 * number(one, "standard_error"), one.value("resolved", false)};
  }
  return largest;
}

class StudyPage {
public:
  StudyPage(const Json& study, const std::filesystem::path& folder)
      : study_(study),
        page_(title_of(study, folder), fmt::format("What accuracy costs in time: a study of grandamp {}, {}",
                                                   text(study, "version"), text(study, "isa"))) {
    for (const Json& setting : study.at("settings"))
      if (setting.value("own", false)) own_ = &setting;
    const double each = number(study, "threads/each");
    time_name_ = fmt::format("{} of a run, s", each == 1.0 ? "processor time" : "wall time");
  }

  Page made() && {
    advice();
    page_.section("frontier", "Error against time");
    page_.add(contact_error());
    page_.add(response_error());
    page_.section("rate", "Rate, and contacts missed");
    page_.add(rate());
    missed();
    settings();
    return std::move(page_);
  }

private:
  void advice() {
    const double done = number(study_, "runs/done"), planned = number(study_, "runs/planned"),
                 seeds = number(study_, "runs/seeds");
    std::string cautions;
    const auto warn = [&cautions](const char* style, const std::string& what) {
      cautions += fmt::format("<li class=\"{}\"><strong>{}</strong></li>\n", style, escaped(what));
    };
    if (done < planned)
      warn("wrong", fmt::format("Not finished: {:.0f} of {:.0f} runs are done. The same command goes on with the rest.",
                                done, planned));
    if (!(seeds >= 2.0)) warn("careful", "One seed: no difference can be told from chance. Use --seeds 3 or more.");
    int stopped = 0;
    for (const Json& setting : study_["settings"]) stopped += text(setting, "stopped").empty() ? 0 : 1;
    if (stopped > 0)
      warn("careful",
           fmt::format("{} setting{} stopped by a guard; see the table.", stopped, stopped == 1 ? " was" : "s were"));
    const char* style = done < planned ? "wrong" : cautions.empty() ? "fine" : "careful";
    page_.section("verdict", "Recommendation");
    const std::string advice = text(study_, "recommended/text");
    page_.add(fmt::format(
        "<div class=\"verdict {}\"><p>{}</p><ul>{}</ul></div>\n", style,
        escaped(advice.empty() ? "No setting can be recommended yet: too few runs are done." : advice), cautions));
    Facts entries{
        {"Error asked for", fmt::format("{:.3g} %", 100.0 * number(study_, "error"))},
        {"By observables", label_of(text(study_, "recommended/by_observables"))},
        {"By single contacts", label_of(text(study_, "recommended/by_contact"))},
        {"The scene's own", own_ != nullptr ? text(*own_, "label") : ""},
        {"Runs", fmt::format("{:.0f} of {:.0f}, {:.0f} seed{}; {:.0f} at a time, {:.0f} thread{} each", done, planned,
                             seeds, seeds == 1.0 ? "" : "s", number(study_, "threads/cases"),
                             number(study_, "threads/each"), number(study_, "threads/each") == 1.0 ? "" : "s")}};
    page_.add(facts(entries));
  }

  std::string label_of(const std::string& name) const {
    for (const Json& setting : study_["settings"])
      if (text(setting, "name") == name && !name.empty()) return text(setting, "label");
    return "";
  }

  void mark(Plot& plot, const char* name, const std::string& of, const char* colour_of, auto value) const {
    for (const Json& setting : study_["settings"])
      if (text(setting, "name") == of && was_run(setting))
        plot.series.push_back({.name = name,
                               .colour = colour_of,
                               .points = {{.x = number(setting, "time"), .y = value(setting)}},
                               .width = 2.0});
  }

  Figure contact_error() const {
    Plot plot;
    plot.title = "Error of a single contact against time";
    plot.x = {.name = time_name_, .logarithmic = true};
    plot.y = {.name = "error of a contact, %", .logarithmic = true};
    PlotSeries frontier{.name = "frontier", .colour = "#9bb7d4", .line = true, .dots = false, .width = 5.0};
    for (const Json& name : study_.value("frontier", Json::array()))
      for (const Json& setting : study_["settings"])
        if (setting["name"] == name)
          frontier.points.push_back({.x = number(setting, "time"), .y = 100.0 * number(setting, "contact_error")});
    plot.series.push_back(std::move(frontier));
    for (const Group& group : groups) {
      if (group.name == std::string_view("friction") || group.name == std::string_view("stiffness"))
        continue; // other contacts
      PlotSeries series{.name = group.name, .colour = group.colour};
      series.line = group.name == std::string_view("steps") || group.name == std::string_view("integrator");
      for (const Json& setting : study_["settings"])
        if (text(setting, "group") == group.name && was_run(setting))
          series.points.push_back(
              {.x = number(setting, "time"), .y = 100.0 * number(setting, "contact_error"), .label = beside(setting)});
      if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    const auto error = [](const Json& setting) { return 100.0 * number(setting, "contact_error"); };
    if (own_ != nullptr) mark(plot, "the scene's own", text(*own_, "name"), "#d32f2f", error);
    return figure_of(plot, "error_time",
                     "Numbers: steps in a contact. The thick line: settings that none beats in both time and error.",
                     "");
  }

  Figure response_error() const {
    Plot plot;
    plot.title = "Difference from the reference against time";
    plot.x = {.name = time_name_, .logarithmic = true};
    plot.y = {.name = "largest difference of an observable, %", .logarithmic = true};
    for (const Group& group : groups) {
      PlotSeries told{.name = group.name, .colour = group.colour}, hidden{.colour = group.colour, .hollow = true};
      for (const Json& setting : study_["settings"]) {
        if (text(setting, "group") != group.name || !was_run(setting) || setting.value("reference", false)) continue;
        const Difference difference = largest_difference(setting);
        if (difference.size == 0.0) continue;
        const double size = 100.0 * difference.size, bar = std::isfinite(difference.bar) ? 100.0 * difference.bar : 0.0;
        (difference.resolved ? told : hidden)
            .points.push_back({number(setting, "time"), size, std::max(size - bar, 0.01), size + bar, beside(setting)});
      }
      if (told.points.empty() && hidden.points.empty()) continue;
      if (told.points.empty()) hidden.name = std::exchange(told.name, "");
      if (!told.points.empty()) plot.series.push_back(std::move(told));
      if (!hidden.points.empty()) plot.series.push_back(std::move(hidden));
    }
    if (own_ != nullptr && !own_->value("reference", false))
      mark(plot, "the scene's own", text(*own_, "name"), "#d32f2f",
           [](const Json& setting) { return 100.0 * largest_difference(setting).size; });
    return figure_of(plot, "response_time",
                     "Hollow: not told from chance. Bars: three standard errors of the scatter between seeds.", "");
  }

  Figure rate() const {
    Plot plot;
    plot.title = "Rate against step";
    plot.x = {.name = "steps in a contact", .logarithmic = true};
    plot.y = {.name = "million granule-steps per second"};
    for (const Group& group : groups) {
      if (group.name != std::string_view("steps") && group.name != std::string_view("integrator") &&
          group.name != std::string_view("precision"))
        continue;
      PlotSeries series{.name = group.name == std::string_view("steps") ? "leapfrog" : group.name,
                        .colour = group.colour,
                        .line = true};
      for (const Json& setting : study_["settings"])
        if (text(setting, "group") == group.name && was_run(setting))
          series.points.push_back(
              {.x = number(setting, "steps_per_contact"), .y = 1e-6 * number(setting, "granule_steps_per_second")});
      std::sort(series.points.begin(), series.points.end(),
                [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
      if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    return figure_of(plot, "rate_step", "", "");
  }

  void missed() {
    Plot plot;
    plot.title = "Contacts that began unlisted, by list policy";
    plot.y = {.name = "missed contacts"};
    PlotSeries series{.colour = colour::purple};
    std::vector<std::vector<std::string>> rows;
    for (const Json& setting : study_["settings"]) {
      if (!setting.contains("audit")) continue;
      std::string name = setting.value("own", false) ? "own" : text(setting, "name");
      if (name.starts_with("policy-")) name = name.substr(7);
      const double count = number(setting, "audit/missed");
      series.points.push_back(
          {.x = static_cast<double>(plot.categories.size()), .y = count, .label = fmt::format("{:.0f}", count)});
      plot.categories.push_back(name);
      rows.push_back({text(setting, "label"), fmt::format("{:.0f}", count),
                      fmt::format("{:.0f}", number(setting, "audit/steps_compared")),
                      fmt::format("{:.3g}", number(setting, "audit/time"))});
    }
    if (rows.empty()) return;
    if (std::all_of(series.points.begin(), series.points.end(), [](const PlotPoint& one) { return one.y == 0.0; })) {
      page_.add("<p>No list policy missed a contact.</p>\n");
      page_.add(table({"policy", "missed", "steps compared", "over, s"}, rows));
      return;
    }
    plot.series.push_back(std::move(series));
    page_.add(figure_of(plot, "missed_policy", "Found by comparing the list with all pairs.",
                        table({"policy", "missed", "steps compared", "over, s"}, rows)));
  }

  void settings() {
    page_.section("settings", "All settings");
    std::vector<std::string> header{"setting", "time, s", "of own", "error of a contact"}, observables;
    for (const Json& setting : study_["settings"])
      if (setting.value("reference", false) && setting.contains("observables"))
        for (const auto& [name, ignored] : setting["observables"].items()) observables.push_back(name);
    for (const std::string& name : observables) header.push_back(in_words(name));
    header.insert(header.end(), {"left of the energy", "missed"});
    std::vector<std::vector<std::string>> rows;
    for (const Json& setting : study_["settings"]) {
      const char* role = setting.value("own", false)         ? " (own)"
                         : setting.value("reference", false) ? " (reference)"
                                                             : "";
      std::vector<std::string> row{text(setting, "label") + role};
      const std::string stopped = text(setting, "stopped");
      if (!was_run(setting)) {
        row.push_back(stopped.empty() ? "not run yet" : "stopped: " + stopped);
        row.resize(header.size());
        rows.push_back(std::move(row));
        continue;
      }
      const double time = number(setting, "time");
      row.push_back(fmt::format("{:.3g} ± {:.0f} %", time, 100.0 * number(setting, "time_spread")));
      row.push_back(own_ != nullptr ? fmt::format("{:.2f}", time / number(*own_, "time")) : "");
      row.push_back(fmt::format("{:.2g} %", 100.0 * number(setting, "contact_error")));
      for (const std::string& name : observables) row.push_back(difference_text(setting, name));
      row.push_back(fmt::format("{:.2g} %", 100.0 * number(setting, "energy_residual")));
      row.push_back(setting.contains("audit") ? fmt::format("{:.0f}", number(setting, "audit/missed")) : "");
      rows.push_back(std::move(row));
    }
    page_.add(table(
        header, rows,
        "Differences from the reference ± three standard errors; in brackets where they are not told from chance."));
    std::string left_out;
    for (const Json& one : study_.value("left_out", Json::array()))
      if (one.is_string()) left_out += "<li>" + escaped(one.get<std::string>()) + "</li>";
    if (!left_out.empty()) page_.add("<p>Left out:</p><ul>" + left_out + "</ul>\n");
  }

  static std::string difference_text(const Json& setting, const std::string& name) {
    if (!setting.contains("observables") || !setting["observables"].contains(name)) return "";
    const Json& one = setting["observables"][name];
    const double bar = 300.0 * number(one, "standard_error"), difference = 100.0 * number(one, "difference");
    const std::string spread = std::isfinite(bar) ? fmt::format(" ± {:.2g} %", bar) : "";
    if (setting.value("reference", false)) return fmt::format("{:.4g}{}", number(one, "mean"), spread);
    return one.value("resolved", false) ? fmt::format("{:+.2g}{}", difference, spread.empty() ? " %" : spread)
                                        : fmt::format("({:+.2g}{})", difference, spread.empty() ? " %" : spread);
  }

  const Json& study_;
  const Json* own_ = nullptr;
  std::string time_name_;
  Page page_;
};

} // namespace

Page study_page(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "study.json";
  const Json study = read_json(file, {"settings"});
  try {
    return StudyPage(study, folder).made();
  } catch (const Json::exception& error) {
    throw FileError(file.string() + ": is damaged: " + error.what());
  }
}

} // namespace grandamp::report
