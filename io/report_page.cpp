#include "io/report_page.hpp"

#include "io/json.hpp"
#include "io/report_assets.hpp"
#include "io/report_data.hpp"
#include "io/text_file.hpp"
#include "io/version.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace grandamp::report {
namespace {

/// {{name}} by its value; values are not looked into.
std::string filled(std::string_view form, const std::map<std::string_view, std::string>& values) {
  std::string text;
  while (true) {
    const std::size_t open = form.find("{{");
    text += form.substr(0, open);
    if (open == std::string_view::npos) return text;
    const std::size_t close = form.find("}}", open);
    text += values.at(form.substr(open + 2, close - open - 2));
    form.remove_prefix(close + 2);
  }
}

std::string script(std::string_view name) {
  std::string_view code = asset(name);
  // A browser's tools would look for the map.
  if (const std::size_t map = code.rfind("//# sourceMappingURL="); map != std::string_view::npos)
    code = code.substr(0, map);
  return fmt::format("<script>\n{}\n</script>\n", code);
}

bool any_of_kind(const std::vector<Figure>& figures, std::string_view kind) {
  return std::any_of(figures.begin(), figures.end(), [kind](const Figure& figure) {
    return figure.live.is_object() && figure.live.at("kind") == kind;
  });
}

} // namespace

std::string embedded(const Json& json) {
  // Text that is not UTF-8 must not cost the page.
  const std::string plain = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string result;
  for (const char c : plain) // "<" stands in strings alone, where its code means the same
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  return result;
}

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows,
                  std::string_view caption) {
  std::string html = "<div class=\"wide\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table>";
  if (!caption.empty()) html += fmt::format("<caption>{}</caption>", escaped(caption));
  html += "<thead><tr>";
  for (const std::string& name : header) html += fmt::format("<th scope=\"col\">{}</th>", escaped(name));
  html += "</tr></thead><tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    html += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      html += k == 0 ? "<th scope=\"row\">" + escaped(row[k]) + "</th>"
                     : (row[k].size() > 60 ? "<td class=\"long\">" : "<td>") + escaped(row[k]) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string facts(const Facts& entries) {
  std::string html = "<dl class=\"facts\">";
  for (const auto& [name, text] : entries)
    if (!text.empty()) html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(name), escaped(text));
  return html + "</dl>\n";
}

Figure figure_of(const Plot& plot, std::string name, std::string caption, std::string numbers) {
  const auto axis = [](const PlotAxis& one) {
    return Json{{"name", one.name}, {"logarithmic", one.logarithmic}, {"from_zero", one.from_zero}};
  };
  Json live{{"kind", "chart"}, {"x", axis(plot.x)}, {"y", axis(plot.y)}};
  if (!plot.categories.empty()) live["categories"] = plot.categories;
  if (plot.band) live["band"] = *plot.band;
  live["series"] = Json::array();
  for (const PlotSeries& series : plot.series) {
    Json one{{"name", series.name}, {"colour", series.colour}, {"line", series.line},
             {"dots", series.dots}, {"hollow", series.hollow}, {"width", series.width}};
    one["points"] = Json::array();
    for (const PlotPoint& point : series.points) {
      Json numbers_of{point.x, point.y, nullptr, nullptr, point.label};
      if (point.high > point.low) {
        numbers_of[2] = point.low;
        numbers_of[3] = point.high;
      }
      one["points"].push_back(std::move(numbers_of));
    }
    live["series"].push_back(std::move(one));
  }
  return {std::move(name), plot.title, std::move(caption), plot.svg(), std::move(live), std::move(numbers)};
}

void Page::section(std::string_view id, std::string_view heading) {
  if (in_section_) body_ += "</section>\n";
  in_section_ = true;
  contents_ += fmt::format("<li><a href=\"#{0}\">{1}</a></li>\n", id, escaped(heading));
  body_ += fmt::format("<section id=\"{0}\" aria-labelledby=\"{0}-heading\">\n<h2 id=\"{0}-heading\">{1}</h2>\n", id,
                       escaped(heading));
}

void Page::add(Figure figure) {
  const bool lives = figure.live.is_object();
  body_ += fmt::format("<figure id=\"{0}\" class=\"{1}\" data-kind=\"{2}\">\n<h3 id=\"{0}-title\">{3}</h3>\n",
                       figure.name, lives ? "lives" : "still-alone",
                       lives ? figure.live.at("kind").get<std::string>() : "", escaped(figure.title));
  if (lives) body_ += "<div class=\"live\"></div>\n";
  body_ +=
      fmt::format("<div class=\"still\" role=\"img\" aria-label=\"{}\">{}</div>\n", escaped(figure.title), figure.svg);
  if (!figure.caption.empty()) body_ += fmt::format("<figcaption>{}</figcaption>\n", escaped(figure.caption));
  if (!figure.numbers.empty())
    body_ += fmt::format(
        "<details class=\"numbers\"><summary>Numbers<span class=\"hidden\"> of {}</span></summary>{}</details>\n",
        escaped(figure.title), figure.numbers);
  body_ += "</figure>\n";
  figures_.push_back(std::move(figure));
}

void Page::add_data(std::string_view name, std::span<const std::byte> bytes) {
  data_ += fmt::format("<script type=\"application/octet-stream\" id=\"data-{}\">{}</script>\n", name, base64(bytes));
}

std::string Page::text() const {
  Json all = script_facts_;
  all["figures"] = Json::object();
  for (const Figure& figure : figures_)
    if (figure.live.is_object()) all["figures"][figure.name] = figure.live;

  const bool histories = any_of_kind(figures_, "history"), charts = any_of_kind(figures_, "chart"),
             granules = any_of_kind(figures_, "granules");
  std::string style(asset("page.css"));
  if (histories) style.insert(0, std::string(asset("dygraph.css")).substr(0, asset("dygraph.css").find("/*#")) + "\n");
  std::string scripts = script("base.js");
  if (histories) scripts += script("dygraph.js") + script("histories.js");
  if (charts) scripts += script("chart.js") + script("charts.js");
  if (granules)
    scripts += script("three.js") + script("orbit_controls.js") + script("spheres.js") + script("granules.js");
  scripts += script("page.js");

  return filled(asset("page.html"),
                {{"title", escaped(title_)},
                 {"subtitle", escaped(subtitle_)},
                 {"style", std::move(style)},
                 {"contents", contents_},
                 {"body", body_ + (in_section_ ? "</section>\n" : "")},
                 {"version", escaped(version())},
                 {"licences", histories || charts || granules ? escaped(asset("licences.txt")) : std::string()},
                 {"report", embedded(all)},
                 {"data", data_},
                 {"scripts", std::move(scripts)}});
}

std::filesystem::path Page::write(const std::filesystem::path& folder) const {
  const std::filesystem::path pictures = folder / "report";
  std::error_code error;
  std::filesystem::create_directories(pictures, error);
  if (error) throw FileError(pictures.string() + ": cannot make the folder: " + error.message());
  for (const Figure& figure : figures_)
    if (!figure.svg.empty()) replace_file(pictures / (figure.name + ".svg"), figure.svg);
  replace_file(folder / "report.html", text());
  return folder / "report.html";
}

} // namespace grandamp::report
