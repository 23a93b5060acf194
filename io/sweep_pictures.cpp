#include "io/sweep_pictures.hpp"

#include "io/case_pool.hpp"
#include "io/svg_plot.hpp"
#include "io/sweep_damping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace grandamp {

namespace {

constexpr std::array<const char*, 8> colours{"#1f4e79", "#b3541e", "#2e7d32", "#7b1fa2",
                                             "#00838f", "#ad1457", "#9e9d24", "#5d4037"};
constexpr const char* bare_colour = "#888888";
constexpr const char* added_colour = "#d32f2f";
constexpr std::size_t most_lines = 12;

std::string with_units(const std::string& key) {
  constexpr std::array<std::array<std::string_view, 2>, 16> units{{{"frequency", "Hz"},
                                                                   {"radius", "m"},
                                                                   {"density", "kg/m^3"},
                                                                   {"mass", "kg"},
                                                                   {"total_mass", "kg"},
                                                                   {"stiffness", "N/m"},
                                                                   {"damping", "N s/m"},
                                                                   {"static_deflection", "m"},
                                                                   {"amplitude", "m"},
                                                                   {"displacement", "m"},
                                                                   {"force", "N"},
                                                                   {"velocity", "m/s"},
                                                                   {"speed", "m/s"},
                                                                   {"diameter", "m"},
                                                                   {"height", "m"},
                                                                   {"duration", "s"}}};
  if (key.starts_with("contact.")) return key;
  const std::size_t dot = key.rfind('.');
  const std::string last = dot == std::string::npos ? key : key.substr(dot + 1);
  for (const auto& [name, unit] : units)
    if (last == name) return fmt::format("{}, {}", key, unit);
  return key;
}

/// Points that differ in the first key alone: one line each.
struct Line {
  std::string name; ///< the other keys' values; empty: there are none
  std::vector<std::size_t> points;
};

std::vector<Line> lines_of(const SweepTable& table) {
  std::size_t others = 1;
  for (std::size_t i = 1; i < table.keys.size(); ++i) others *= table.keys[i].values.size();
  std::vector<Line> lines(std::min(others, most_lines));
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    if (k % others >= lines.size()) continue;
    Line& line = lines[k % others];
    if (line.points.empty())
      for (std::size_t i = 1; i < table.keys.size(); ++i)
        line.name += fmt::format("{}{} = {}", i > 1 ? ", " : "", table.keys[i].key, table.points[k].values[i].text);
    line.points.push_back(k);
  }
  return lines;
}

using Abscissa = std::function<double(std::size_t)>;

/// A number of the table along a line, with bars of one standard error; hollow where a run was not steady.
void add_line(Plot& plot, const SweepTable& table, const Line& line, const std::string& number, double factor,
              const std::string& name, const std::string& colour, const Abscissa& x) {
  PlotSeries all{.name = name, .colour = colour, .line = true}, unsteady{.colour = colour, .hollow = true};
  for (const std::size_t k : line.points) {
    const MeanAndError* found = table.results[k].find(number);
    if (found == nullptr || found->count == 0) continue;
    const double error = std::isnan(found->error) ? 0.0 : found->error;
    const PlotPoint point{.x = x(k),
                          .y = factor * found->mean,
                          .low = factor * (found->mean - error),
                          .high = factor * (found->mean + error)};
    all.points.push_back(point);
    if (table.points[k].structure && !table.results[k].steady()) unsteady.points.push_back(point);
  }
  if (all.points.empty()) return;
  plot.series.push_back(all);
  if (!unsteady.points.empty()) plot.series.push_back(unsteady);
}

bool any_unsteady(const SweepTable& table) {
  for (std::size_t k = 0; k < table.points.size(); ++k)
    if (table.points[k].structure && table.results[k].done > 0 && !table.results[k].steady()) return true;
  return false;
}

std::string heading(const SweepTable& table, const std::string& what) {
  std::string text = what;
  if (table.seeds > 1) text += fmt::format("; {} seeds, bars: standard error", table.seeds);
  if (any_unsteady(table)) text += "; hollow: not all runs steady";
  return text;
}

/// Equal factors from value to value ask for a logarithmic axis.
bool by_factors(const VariedKey& key) {
  const std::vector<VaryValue>& values = key.values;
  return values.size() > 2 && *values.front().number > 0.0 && *values.back().number > 0.0 &&
         std::max(*values.back().number / *values.front().number, *values.front().number / *values.back().number) >
             20.0;
}

Abscissa along_first_key(const SweepTable& table) {
  return [&table](std::size_t k) { return table.points[k].values[0].number.value_or(0.0); };
}

PlotAxis first_axis(const SweepTable& table) {
  return {with_units(table.keys[0].key), by_factors(table.keys[0]), false};
}

struct Shown {
  std::string number, name;
  double factor;
};

/// Words along x: a bar each.
Plot bars(const SweepTable& table, const Shown& shown) {
  Plot plot;
  plot.title = heading(table, table.title);
  plot.y = {shown.name};
  plot.x.name = table.keys[0].key;
  PlotSeries series{.colour = colours[0]};
  const Line line = lines_of(table).front();
  if (!line.name.empty()) plot.title += "; " + line.name;
  for (const std::size_t k : line.points) {
    const MeanAndError* found = table.results[k].find(shown.number);
    if (found == nullptr || found->count == 0) continue;
    const double error = std::isnan(found->error) ? 0.0 : found->error;
    series.points.push_back({.x = static_cast<double>(plot.categories.size()),
                             .y = shown.factor * found->mean,
                             .low = shown.factor * (found->mean - error),
                             .high = shown.factor * (found->mean + error),
                             .label = fmt::format("{:.4g}", shown.factor * found->mean)});
    plot.categories.push_back(table.points[k].values[0].text);
  }
  plot.series.push_back(series);
  return plot;
}

Plot main_picture(const SweepTable& table, const Shown& shown) {
  if (!table.keys[0].numeric()) return bars(table, shown);
  Plot plot;
  plot.title = heading(table, table.title);
  plot.x = first_axis(table);
  plot.y = {shown.name, false, false};
  const std::vector<Line> lines = lines_of(table);
  for (std::size_t i = 0; i < lines.size(); ++i)
    add_line(plot, table, lines[i], shown.number, shown.factor, lines[i].name, colours[i % colours.size()],
             along_first_key(table));
  return plot;
}

Plot dissipation_picture(const SweepTable& table) {
  Plot plot;
  plot.title = heading(table, "Energy taken since t = 0, by mechanism");
  plot.x = first_axis(table);
  plot.y = {"J"};
  const Line line = lines_of(table).front();
  if (!line.name.empty()) plot.title += "; " + line.name;
  constexpr std::array<std::array<const char*, 2>, 5> mechanisms{{{"normal_granule", "impacts, granules"},
                                                                  {"normal_wall", "impacts, walls"},
                                                                  {"friction_granule", "friction, granules"},
                                                                  {"friction_wall", "friction, walls"},
                                                                  {"structural_damping", "structural damping"}}};
  for (std::size_t i = 0; i < mechanisms.size(); ++i)
    add_line(plot, table, line, std::string("energy.") + mechanisms[i][0], 1.0, mechanisms[i][1], colours[i],
             along_first_key(table));
  return plot;
}

/// The closed form between the least and the greatest frequency.
PlotSeries closed_form(const SweepTable& table, const CasePoint& point, double added_mass, const char* name,
                       const char* colour) {
  PlotSeries series{.name = name, .colour = colour, .line = true, .dots = false};
  double low = *table.keys[0].values.front().number, high = low;
  for (const VaryValue& value : table.keys[0].values) {
    low = std::min(low, *value.number);
    high = std::max(high, *value.number);
  }
  constexpr int pieces = 400;
  for (int i = 0; i <= pieces; ++i) {
    const double frequency = low + (high - low) * i / pieces;
    series.points.push_back({.x = frequency, .y = 1e3 * closed_form_amplitude(point, added_mass, frequency)});
  }
  return series;
}

Plot response_picture(const SweepTable& table) {
  Plot plot;
  plot.title = heading(table, "Frequency response");
  plot.x = {"frequency, Hz", false, false};
  plot.y = {"amplitude, mm"};
  const std::vector<Line> lines = lines_of(table);
  std::vector<std::array<double, 2>> drawn;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto whole = std::find_if(lines[i].points.begin(), lines[i].points.end(),
                                    [&](std::size_t k) { return is_forced_structure(table.points[k]); });
    if (whole == lines[i].points.end()) continue;
    const CasePoint& point = table.points[*whole];
    const double middle = 0.5 * (*table.keys[0].values.front().number + *table.keys[0].values.back().number);
    const std::array<double, 2> here{closed_form_amplitude(point, 0.0, middle), point.granule_mass};
    if (std::none_of(drawn.begin(), drawn.end(), [&](const auto& one) { return one[0] == here[0]; }))
      plot.series.push_back(closed_form(table, point, 0.0, "bare structure (closed form)", bare_colour));
    // Kept masses differ in their last bits.
    const auto same = [&](const auto& one) { return one[0] == here[0] && std::abs(one[1] - here[1]) < 1e-9 * here[1]; };
    if (point.granule_mass > 0.0 && std::none_of(drawn.begin(), drawn.end(), same))
      plot.series.push_back(
          closed_form(table, point, point.granule_mass, "granules as added mass (closed form)", added_colour));
    drawn.push_back(here);
    add_line(plot, table, lines[i], "structure.amplitude", 1e3, lines[i].name.empty() ? "with granules" : lines[i].name,
             colours[i % colours.size()], along_first_key(table));
  }
  return plot;
}

std::string columns(const SweepTable& table, std::size_t k, const std::vector<std::string>& numbers) {
  std::string text;
  for (const std::string& one : numbers) {
    const MeanAndError* found = table.results[k].find(one);
    text += found != nullptr ? ',' + csv_number(found->mean) + ',' + csv_number(found->error) : ",,";
  }
  return text;
}

std::string keys_header(const SweepTable& table) {
  std::string text;
  for (const VariedKey& key : table.keys) text += csv_text(key.key) + ',';
  return text;
}

std::string keys_of(const SweepTable& table, std::size_t k) {
  std::string text;
  for (const VaryValue& value : table.points[k].values) text += csv_text(value.text) + ',';
  return text;
}

std::string response_csv(const SweepTable& table) {
  std::string text = keys_header(table) + "seeds,steady,amplitude,amplitude_error,rms_displacement,"
                                          "rms_displacement_error,bare_amplitude,added_mass_amplitude\n";
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    const CasePoint& point = table.points[k];
    text += keys_of(table, k) + fmt::format("{},{:d}", table.results[k].done, table.results[k].steady());
    text += columns(table, k, {"structure.amplitude", "structure.rms_displacement"});
    text += is_forced_structure(point)
                ? fmt::format(",{},{}\n", closed_form_amplitude(point, 0.0, point.excitation.frequency),
                              closed_form_amplitude(point, point.granule_mass, point.excitation.frequency))
                : ",,\n";
  }
  return text;
}

const std::vector<std::string> damping_numbers{
    "damping.acceleration",   "structure.amplitude", "damping.dissipated",
    "damping.normal_granule", "damping.normal_wall", "damping.friction_granule",
    "damping.friction_wall",  "damping.loss_factor", "damping.ratio"};

std::string damping_csv(const SweepTable& table) {
  std::string text = keys_header(table) + "seeds,steady";
  for (const std::string& one : damping_numbers) {
    const std::string short_name = one.substr(one.find('.') + 1);
    text += fmt::format(",{0},{0}_error", short_name);
  }
  text += '\n';
  for (std::size_t k = 0; k < table.points.size(); ++k)
    text += keys_of(table, k) + fmt::format("{},{:d}", table.results[k].done, table.results[k].steady()) +
            columns(table, k, damping_numbers) + '\n';
  return text;
}

Plot damping_picture(const SweepTable& table) {
  const bool ratio = table.points.front().structure.has_value();
  Plot plot;
  plot.title = heading(table, ratio ? "Equivalent damping ratio of the granules" : "Loss factor");
  plot.x = {"dimensionless acceleration, peak over g", by_factors(table.keys[0]), false};
  plot.y = {ratio ? "damping ratio, %" : "energy per cycle over 2 pi m v^2 / 2 of the granules"};
  const std::vector<Line> lines = lines_of(table);
  for (std::size_t i = 0; i < lines.size(); ++i)
    add_line(plot, table, lines[i], ratio ? "damping.ratio" : "damping.loss_factor", ratio ? 100.0 : 1.0, lines[i].name,
             colours[i % colours.size()], [&table](std::size_t k) {
               const MeanAndError* found = table.results[k].find("damping.acceleration");
               return found != nullptr ? found->mean : std::nan("");
             });
  return plot;
}

Shown shown_in(const SweepTable& table) {
  const auto has = [&table](const char* one) {
    return std::find(table.names.begin(), table.names.end(), one) != table.names.end();
  };
  if (has("structure.rms_displacement")) return {"structure.rms_displacement", "rms displacement, mm", 1e3};
  if (has("energy.dissipated")) return {"energy.dissipated", "energy taken by contacts, J", 1.0};
  return {"verlet.contacts_per_granule", "contacts of a granule", 1.0};
}

} // namespace

bool is_response(const SweepTable& table) {
  return table.keys[0].key == "excitation.frequency" && table.keys[0].numeric() &&
         std::any_of(table.points.begin(), table.points.end(), is_forced_structure);
}

bool is_damping(const SweepTable& table) {
  const std::string& key = table.keys[0].key;
  return table.keys[0].numeric() &&
         (key == "excitation.static_deflection" || key == "excitation.force" || key == "excitation.amplitude");
}

void write_sweep_pictures(SweepTable& table) {
  const auto picture = [&table](const char* name, const Plot& plot) {
    replace_shared_file(table.folder / name, plot.svg());
    table.pictures.emplace_back(name);
  };
  table.pictures.clear();
  if (table.names.empty()) return; // nothing is done
  picture("sweep.svg", main_picture(table, shown_in(table)));
  const bool ledger = std::find(table.names.begin(), table.names.end(), "energy.dissipated") != table.names.end();
  if (ledger && table.keys[0].numeric()) picture("dissipation.svg", dissipation_picture(table));
  if (is_response(table)) {
    picture("response.svg", response_picture(table));
    replace_shared_file(table.folder / "response.csv", response_csv(table));
  }
  if (is_damping(table)) {
    picture("damping.svg", damping_picture(table));
    replace_shared_file(table.folder / "damping.csv", damping_csv(table));
  }
}

} // namespace grandamp
