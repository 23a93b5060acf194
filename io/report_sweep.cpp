#include "io/report_sweep.hpp"

#include "io/json.hpp"
#include "io/report_data.hpp"
#include "io/report_files.hpp"
#include "io/report_histories.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace grandamp::report {
namespace {

namespace fs = std::filesystem;

constexpr std::array line_colours{colour::blue,   colour::vermilion, colour::green, colour::orange,
                                  colour::purple, colour::sky,       colour::grey};

struct Quantity {
  const char* name; ///< of sweep.json
  const char* title;
  const char* unit; ///< SI; "%": a share
};
constexpr Quantity drawn[] = {{"structure.amplitude", "Amplitude", "m"},
                              {"structure.rms_displacement", "rms displacement", "m"},
                              {"damping.ratio", "Equivalent damping ratio of the granules", "%"},
                              {"damping.loss_factor", "Loss factor", "1"},
                              {"energy.dissipated", "Energy that contacts took", "J"}};
constexpr Quantity mechanisms[] = {{"energy.structural_damping", "the structure's own damper", "J"},
                                   {"energy.normal_granule", "impacts between granules", "J"},
                                   {"energy.normal_wall", "impacts on the enclosure", "J"},
                                   {"energy.friction_granule", "friction between granules", "J"},
                                   {"energy.friction_wall", "friction on the enclosure", "J"}};

std::string value_text(const Json& value) {
  if (value.is_number()) return fmt::format("{:.6g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

class SweepPage {
public:
  SweepPage(const Json& sweep, const fs::path& folder)
      : sweep_(sweep), folder_(folder),
        page_(title_of(sweep, folder), fmt::format("A sweep of grandamp {}, {}; results of {}", text(sweep, "version"),
                                                   text(sweep, "isa"), time_of(folder / "sweep.json"))) {
    for (const Json& key : sweep.at("vary")) keys_.push_back(key.at("key").get<std::string>());
    if (keys_.empty()) throw FileError((folder / "sweep.json").string() + ": is damaged: nothing was varied");
    const Json& values = sweep["vary"][0].at("values");
    numeric_ = std::all_of(values.begin(), values.end(), [](const Json& value) { return value.is_number(); });
    several_seeds_ = sweep.value("seeds", Json::array()).size() > 1;
    gather_lines();
  }

  Page made() && {
    verdict();
    description();
    page_.section("curves", "Curves");
    if (numeric_) {
      response();
      for (const Quantity& quantity : drawn) curve(quantity);
      dissipation();
    } else {
      for (const Quantity& quantity : drawn) bars(quantity);
    }
    points();
    return std::move(page_);
  }

private:
  /// Points that differ in the first key alone.
  struct Line {
    std::string name;
    std::vector<const Json*> points;
  };

  void gather_lines() {
    for (const Json& point : sweep_["points"]) {
      std::string name;
      for (std::size_t k = 1; k < keys_.size(); ++k)
        name += fmt::format("{}{} = {}", k > 1 ? ", " : "", keys_[k], value_text(point.at("values").at(keys_[k])));
      const auto found =
          std::find_if(lines_.begin(), lines_.end(), [&name](const Line& line) { return line.name == name; });
      (found != lines_.end() ? *found : lines_.emplace_back(Line{name, {}})).points.push_back(&point);
    }
  }

  double place(const Json& point) const { return number_of(point.at("values"), keys_[0]); }
  static double mean(const Json& point, const std::string& name) {
    return number_of(point.value("mean", Json::object()), name);
  }
  static double error(const Json& point, const std::string& name) {
    return number_of(point.value("error", Json::object()), name);
  }
  static bool is_steady(const Json& point) {
    return !point.contains("steady") || !point["steady"].is_boolean() || point["steady"].get<bool>();
  }

  void verdict() {
    int unsteady = 0, unfinished = 0, residuals = 0, missed = 0;
    std::string failures;
    for (const Json& point : sweep_["points"]) {
      if (number(point, "done") > 0.0 && !is_steady(point)) ++unsteady;
      if (text(point, "status") != "done") ++unfinished;
      if (mean(point, "energy.residual") > 0.01) ++residuals;
      if (mean(point, "verlet.missed") > 0.0) ++missed;
      for (const Json& run : point.value("runs", Json::array()))
        if (text(run, "status") == "failed")
          failures += fmt::format("<li class=\"wrong\"><strong>{} failed:</strong> {}</li>\n",
                                  escaped(text(run, "folder")), escaped(text(run, "error")));
    }
    std::string list;
    bool wrong = false, careful = false;
    const auto add = [&](bool grave, const std::string& what, const std::string& so) {
      (grave ? wrong : careful) = true;
      list += fmt::format("<li class=\"{}\"><strong>{}</strong> {}</li>\n", grave ? "wrong" : "careful", escaped(what),
                          escaped(so));
    };
    const std::size_t all = sweep_["points"].size();
    const auto of_all = [all](int count) { return fmt::format("{} of {} points", count, all); };
    if (unfinished > 0)
      add(true,
          fmt::format("{} of {} runs are done, {} failed; {} lack some of theirs.", number(sweep_, "runs/done"),
                      number(sweep_, "runs/planned"), number(sweep_, "runs/failed"), of_all(unfinished)),
          "The same command goes on with what is missing.");
    if (unsteady > 0)
      add(false, fmt::format("{} are not steady: hollow in the curves, marked in the table.", of_all(unsteady)),
          "There the mean says little; run longer, or let the window begin later.");
    if (residuals > 0)
      add(false, fmt::format("The energy balance of {} is off by more than 1 %.", of_all(residuals)),
          "Raise time.steps_per_contact.");
    if (missed > 0)
      add(false, fmt::format("At {} contacts were missed.", of_all(missed)), "Use verlet.policy = \"guarded\".");
    if (!several_seeds_)
      add(false, "One seed: there are no error bars.",
          "Differences between points may be chance; use --seeds 3 or more.");
    if (several_seeds_)
      list += fmt::format("<li class=\"fine\">Bars of error: one standard error of the mean over {} seeds.</li>\n",
                          sweep_["seeds"].size());
    const char* style = wrong ? "wrong" : careful ? "careful" : "fine";
    const char* mark = wrong ? "✕" : careful ? "!" : "✓";
    const char* words = wrong     ? "Not complete"
                        : careful ? "Read with care"
                                  : "Nothing was found that speaks against these numbers";
    page_.section("verdict", "Verdict");
    page_.add(fmt::format("<div class=\"verdict {}\"><p class=\"headline\"><span class=\"mark\" "
                          "aria-hidden=\"true\">{}</span> {}</p>\n<ul>\n{}{}</ul></div>\n",
                          style, mark, words, list, failures));
  }

  void description() {
    page_.section("sweep", "What was varied");
    Facts entries;
    for (const Json& key : sweep_["vary"]) {
      std::string values;
      for (const Json& value : key.at("values")) values += (values.empty() ? "" : ", ") + value_text(value);
      entries.emplace_back(key.at("key").get<std::string>(), values);
    }
    entries.emplace_back("Kept", text(sweep_, "keep") == "total_mass" ? "the granules' total mass" : "");
    std::string seeds;
    for (const Json& seed : sweep_.value("seeds", Json::array()))
      seeds += (seeds.empty() ? "" : ", ") + value_text(seed);
    entries.emplace_back("Seeds", seeds);
    entries.emplace_back("Runs", fmt::format("{} planned, {} done, {} failed", number(sweep_, "runs/planned"),
                                             number(sweep_, "runs/done"), number(sweep_, "runs/failed")));
    best(entries);
    page_.add(facts(entries));
    page_.add(
        fmt::format("<details><summary>The scene that was varied</summary><pre tabindex=\"0\">{}</pre></details>\n",
                    escaped(text(sweep_, "scene"))));
  }

  /// The point with the smallest amplitude, if the next one can be told from it.
  void best(Facts& entries) const {
    const char* name = "structure.rms_displacement";
    const Json* least = nullptr;
    for (const Json& point : sweep_["points"])
      if (std::isfinite(mean(point, name)) && (least == nullptr || mean(point, name) < mean(*least, name)))
        least = &point;
    if (least == nullptr || sweep_["points"].size() < 2) return;
    int rivals = 0;
    for (const Json& point : sweep_["points"]) {
      const double apart = mean(point, name) - mean(*least, name),
                   spread = std::hypot(error(point, name), error(*least, name));
      if (&point != least && std::isfinite(apart) && apart < 2.0 * spread) ++rivals;
    }
    std::string where;
    for (const std::string& key : keys_)
      where += fmt::format("{}{} = {}", where.empty() ? "" : ", ", key, value_text(least->at("values").at(key)));
    entries.emplace_back(
        "Least rms displacement",
        fmt::format("{}{} at {}{}", readable(mean(*least, name), "m"),
                    std::isfinite(error(*least, name)) ? " ± " + readable(error(*least, name), "m", 2) : "", where,
                    !several_seeds_ ? ""
                    : rivals == 0   ? "; no other is within two standard errors"
                                    : fmt::format("; {} other{} within two standard errors", rivals,
                                                rivals == 1 ? " is" : "s are")));
  }

  ReadableUnit unit_for(const Quantity& quantity) const {
    if (quantity.unit == std::string_view("%")) return {100.0, "%"};
    double largest = 0.0;
    for (const Json& point : sweep_["points"])
      if (const double value = mean(point, quantity.name); std::isfinite(value))
        largest = std::max(largest, std::abs(value));
    return readable_unit(largest, quantity.unit);
  }

  /// The line, and over it its points: full or, where runs were not steady, hollow.
  void add_line(Plot& plot, const Line& line, const std::string& quantity, double factor, const std::string& name,
                const char* line_colour) const {
    PlotSeries whole{.name = name, .colour = line_colour, .line = true}, hollow{.colour = line_colour, .hollow = true};
    for (const Json* point : line.points) {
      const double y = mean(*point, quantity) * factor, spread = error(*point, quantity) * factor;
      if (!std::isfinite(y) || !std::isfinite(place(*point))) continue;
      PlotPoint one{.x = place(*point), .y = y};
      if (std::isfinite(spread)) {
        one.low = y - spread;
        one.high = y + spread;
      }
      whole.points.push_back(one);
      if (!is_steady(*point)) hollow.points.push_back({.x = one.x, .y = one.y});
    }
    const auto by_place = [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; };
    std::sort(whole.points.begin(), whole.points.end(), by_place);
    if (whole.points.empty()) return;
    plot.series.push_back(std::move(whole));
    if (!hollow.points.empty()) plot.series.push_back(std::move(hollow));
  }

  Plot empty_plot(const std::string& title, const std::string& y) const {
    Plot plot;
    plot.title = fmt::format("{} against {}", title, keys_[0]);
    plot.x = {.name = keys_[0], .from_zero = false};
    plot.y = {.name = y};
    return plot;
  }

  std::string numbers_of(const Quantity& quantity, const ReadableUnit& unit) const {
    std::vector<std::string> header = keys_;
    header.push_back(fmt::format("{}, {}", quantity.title, unit.name));
    header.emplace_back("standard error");
    header.emplace_back("steady");
    std::vector<std::vector<std::string>> rows;
    for (const Json& point : sweep_["points"]) {
      std::vector<std::string> row;
      for (const std::string& key : keys_) row.push_back(value_text(point.at("values").at(key)));
      const double spread = error(point, quantity.name);
      row.push_back(fmt::format("{:.5g}", mean(point, quantity.name) * unit.factor));
      row.push_back(std::isfinite(spread) ? fmt::format("{:.2g}", spread * unit.factor) : "one seed");
      row.emplace_back(is_steady(point) ? "yes" : "no");
      rows.push_back(std::move(row));
    }
    return table(header, rows);
  }

  bool has(const Quantity& quantity) const {
    return std::any_of(sweep_["points"].begin(), sweep_["points"].end(),
                       [&quantity](const Json& point) { return std::isfinite(mean(point, quantity.name)); });
  }

  static std::string picture_name(const Quantity& quantity) {
    std::string name = quantity.name;
    std::replace(name.begin(), name.end(), '.', '_');
    return name;
  }

  void curve(const Quantity& quantity) {
    if (!has(quantity)) return;
    if (closed_forms_drawn_ && quantity.name == std::string_view("structure.amplitude")) return;
    const ReadableUnit unit = unit_for(quantity);
    Plot plot = empty_plot(quantity.title,
                           unit.name.empty() ? quantity.title : fmt::format("{}, {}", quantity.title, unit.name));
    for (std::size_t k = 0; k < lines_.size(); ++k)
      add_line(plot, lines_[k], quantity.name, unit.factor, lines_[k].name, line_colours[k % line_colours.size()]);
    page_.add(figure_of(plot, picture_name(quantity), caption(), numbers_of(quantity, unit)));
  }

  std::string caption() const {
    return several_seeds_ ? "Bars: one standard error of the mean over seeds. Hollow: not steady."
                          : "One seed, no error bars. Hollow: not steady.";
  }

  /// Amplitude with granules, and the closed forms of the structure alone and with their mass fixed to it.
  void response() {
    const fs::path file = folder_ / "response.csv";
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return;
    const CsvColumns columns = read_csv(file);
    const std::vector<double>*x = columns.find(keys_[0]), *bare = columns.find("bare_amplitude"),
          *added = columns.find("added_mass_amplitude");
    if (x == nullptr || bare == nullptr || added == nullptr) return;
    const Quantity& quantity = drawn[0];
    const ReadableUnit unit = unit_for(quantity);
    Plot plot = empty_plot("Frequency response: amplitude", "Amplitude, " + unit.name);
    plot.x.name = "frequency, Hz";
    const auto closed = [&](const char* name, const char* line_colour, const std::vector<double>& values) {
      std::map<double, double> sorted;
      for (std::size_t k = 0; k < x->size(); ++k)
        if (std::isfinite(values[k])) sorted.emplace((*x)[k], values[k] * unit.factor);
      PlotSeries series{.name = name, .colour = line_colour, .line = true, .dots = false, .width = 2.0};
      for (const auto& [at, value] : sorted) series.points.push_back({.x = at, .y = value});
      if (!series.points.empty()) plot.series.push_back(std::move(series));
    };
    closed("bare structure", colour::grey, *bare);
    if (lines_.size() == 1) closed("granules as added mass", colour::orange, *added);
    for (std::size_t k = 0; k < lines_.size(); ++k)
      add_line(plot, lines_[k], quantity.name, unit.factor, lines_[k].name.empty() ? "with granules" : lines_[k].name,
               line_colours[k == 0 ? 0 : 1 + (k - 1) % (line_colours.size() - 2)]);
    closed_forms_drawn_ = true;
    page_.add(figure_of(plot, "response",
                        caption() + " Lines without dots: closed forms, drawn between the sweep's frequencies.",
                        numbers_of(quantity, unit)));
  }

  void dissipation() {
    if (lines_.empty() || !has(mechanisms[1])) return;
    Quantity all{"energy.dissipated", "", "J"};
    const ReadableUnit unit = unit_for(all);
    Plot plot = empty_plot("Energy lost by mechanism", "energy since t = 0, " + unit.name);
    static constexpr const char* colours[] = {colour::grey, colour::blue, colour::sky, colour::vermilion,
                                              colour::orange};
    for (std::size_t k = 0; k < std::size(mechanisms); ++k)
      add_line(plot, lines_.front(), mechanisms[k].name, unit.factor, mechanisms[k].title, colours[k]);
    page_.add(figure_of(plot, "dissipation", lines_.size() > 1 ? "At " + lines_.front().name + "." : caption(), ""));
  }

  void bars(const Quantity& quantity) {
    if (!has(quantity)) return;
    const ReadableUnit unit = unit_for(quantity);
    Plot plot;
    plot.title = fmt::format("{} by {}", quantity.title, keys_[0]);
    plot.y = {.name = unit.name.empty() ? quantity.title : fmt::format("{}, {}", quantity.title, unit.name)};
    PlotSeries series{.colour = colour::blue};
    for (const Json* point : lines_.front().points) {
      const double y = mean(*point, quantity.name) * unit.factor, spread = error(*point, quantity.name) * unit.factor;
      if (!std::isfinite(y)) continue;
      PlotPoint one{
          .x = static_cast<double>(plot.categories.size()), .y = y, .label = is_steady(*point) ? "" : "not steady"};
      if (std::isfinite(spread)) {
        one.low = y - spread;
        one.high = y + spread;
      }
      series.points.push_back(one);
      plot.categories.push_back(value_text(point->at("values").at(keys_[0])));
    }
    plot.series.push_back(std::move(series));
    page_.add(figure_of(plot, picture_name(quantity), lines_.size() > 1 ? "At " + lines_.front().name + "." : caption(),
                        numbers_of(quantity, unit)));
  }

  void points() {
    page_.section("points", "All points");
    std::vector<std::string> header = keys_;
    for (const char* name : {"granules", "seeds", "status", "steady"}) header.emplace_back(name);
    std::vector<std::pair<Quantity, ReadableUnit>> shown;
    for (const Quantity& quantity : drawn)
      if (has(quantity)) shown.emplace_back(quantity, unit_for(quantity));
    if (has({"energy.residual", "", "%"}))
      shown.push_back({{"energy.residual", "left of the energy", "%"}, {100.0, "%"}});
    for (const auto& [quantity, unit] : shown)
      header.push_back(unit.name.empty() ? quantity.title : fmt::format("{}, {}", quantity.title, unit.name));
    std::vector<std::vector<std::string>> rows;
    for (const Json& point : sweep_["points"]) {
      std::vector<std::string> row;
      for (const std::string& key : keys_) row.push_back(value_text(point.at("values").at(key)));
      row.push_back(fmt::format("{:.0f}", number(point, "granules")));
      row.push_back(fmt::format("{:.0f}", number(point, "done")));
      row.push_back(text(point, "status"));
      row.emplace_back(
          point.contains("steady") && point["steady"].is_boolean() ? (is_steady(point) ? "yes" : "NOT STEADY") : "");
      for (const auto& [quantity, unit] : shown) {
        const double value = mean(point, quantity.name) * unit.factor,
                     spread = error(point, quantity.name) * unit.factor;
        row.push_back(!std::isfinite(value)   ? ""
                      : std::isfinite(spread) ? fmt::format("{:.4g} ± {:.2g}", value, spread)
                                              : fmt::format("{:.4g}", value));
      }
      rows.push_back(std::move(row));
    }
    page_.add(table(header, rows, several_seeds_ ? "Means over seeds ± one standard error." : "One run each."));
  }

  const Json& sweep_;
  fs::path folder_;
  std::vector<std::string> keys_;
  std::vector<Line> lines_;
  bool numeric_ = true, several_seeds_ = false, closed_forms_drawn_ = false;
  Page page_;
};

} // namespace

Page sweep_page(const fs::path& folder) {
  const fs::path file = folder / "sweep.json";
  const Json sweep = read_json(file, {"vary", "points"});
  try {
    return SweepPage(sweep, folder).made();
  } catch (const Json::exception& error) {
    throw FileError(file.string() + ": is damaged: " + error.what());
  }
}

} // namespace grandamp::report
