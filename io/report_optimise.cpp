// The page of a search for a design.
#include "io/json.hpp"
#include "io/report_data.hpp"
#include "io/report_files.hpp"
#include "io/report_histories.hpp"
#include "io/report_sweep.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grandamp::report {
namespace {

namespace fs = std::filesystem;

class OptimisePage {
public:
  OptimisePage(const Json& search, const fs::path& folder)
      : search_(search), evaluations_(search.at("evaluations")),
        aim_(text(search, "maximise").empty() ? text(search, "minimise") : text(search, "maximise")),
        page_(title_of(search, folder),
              fmt::format("A search for the best design by grandamp {}, {}; results of {}", text(search, "version"),
                          text(search, "isa"), time_of(folder / "optimise.json"))) {
    const std::string wanted = aim_.ends_with("displacement") || aim_.ends_with("amplitude") ? "m" : "1";
    double largest = 0.0;
    for (const Json& one : evaluations_)
      if (std::isfinite(number(one, "mean"))) largest = std::max(largest, std::abs(number(one, "mean")));
    unit_ = readable_unit(largest, wanted);
    axis_ = unit_.name.empty() ? aim_ : fmt::format("{}, {}", aim_, unit_.name);
  }

  Page made() && {
    verdict();
    page_.section("path", "The path to it");
    path();
    for (const Json& key : search_.at("over")) against(text(key, "key"), key.value("logarithmic", false));
    designs();
    page_.section("scene", "The scene that was varied");
    page_.add(fmt::format("<pre tabindex=\"0\">{}</pre>\n", escaped(text(search_, "scene"))));
    return std::move(page_);
  }

private:
  void verdict() {
    const bool done = text(search_, "status") == "done";
    const std::string words = text(search_, "text");
    std::string list;
    if (!done) list += "<li class=\"wrong\"><strong>Not finished.</strong> The same command goes on with it.</li>\n";
    const double seeds = number(search_, "seeds");
    if (!(seeds >= 2.0))
      list += "<li class=\"careful\"><strong>One seed:</strong> designs may differ by chance alone.</li>\n";
    page_.section("verdict", "The best design");
    page_.add(fmt::format("<div class=\"verdict {}\"><p>{}</p><ul>{}</ul></div>\n",
                          !done          ? "wrong"
                          : list.empty() ? "fine"
                                         : "careful",
                          escaped(words.empty() ? "No design is good yet." : words), list));
    Facts entries{{text(search_, "maximise").empty() ? "Minimised" : "Maximised", aim_}};
    for (const Json& key : search_.at("over"))
      entries.emplace_back(text(key, "key"), fmt::format("{:.6g} to {:.6g}", number(key, "from"), number(key, "to")));
    entries.emplace_back("Kept", text(search_, "keep") == "total_mass" ? "the granules' total mass" : "");
    entries.emplace_back("Seeds", fmt::format("{:.0f}", seeds));
    entries.emplace_back("Ended", text(search_, "reason"));
    page_.add(facts(entries));
  }

  PlotPoint point(const Json& one, double x) const {
    const double y = number(one, "mean") * unit_.factor, spread = number(one, "standard_error") * unit_.factor;
    PlotPoint made{.x = x, .y = y};
    if (std::isfinite(spread)) {
      made.low = y - spread;
      made.high = y + spread;
    }
    return made;
  }

  bool is_best(std::size_t k) const { return number(search_, "best") == static_cast<double>(k); }

  Plot empty_plot(const std::string& title) const {
    Plot plot;
    plot.title = title;
    plot.y = {.name = axis_, .from_zero = false};
    return plot;
  }

  /// All designs and, larger to the eye, the best.
  void add_points(Plot& plot, auto place) const {
    PlotSeries all{.name = "each design", .colour = colour::blue},
        best{.name = "the best", .colour = colour::vermilion};
    for (std::size_t k = 0; k < evaluations_.size(); ++k) {
      if (!std::isfinite(number(evaluations_[k], "mean"))) continue;
      (is_best(k) ? best : all).points.push_back(point(evaluations_[k], place(k)));
    }
    if (!all.points.empty()) plot.series.push_back(std::move(all));
    if (!best.points.empty()) plot.series.push_back(std::move(best));
  }

  void path() {
    Plot plot = empty_plot("Design by design");
    plot.x = {.name = "design, in the order tried", .from_zero = false};
    PlotSeries so_far{.name = "best so far", .colour = colour::grey, .line = true, .dots = false, .width = 2.0};
    for (std::size_t k = 0; k < evaluations_.size(); ++k)
      if (const double best = number(evaluations_[k], "best_so_far") * unit_.factor; std::isfinite(best))
        so_far.points.push_back({.x = static_cast<double>(k + 1), .y = best});
    if (!so_far.points.empty()) plot.series.push_back(std::move(so_far));
    add_points(plot, [](std::size_t k) { return static_cast<double>(k + 1); });
    page_.add(figure_of(plot, "path", "Bars: one standard error of the mean over seeds.", ""));
  }

  void against(const std::string& key, bool logarithmic) {
    Plot plot = empty_plot(fmt::format("{} against {}", aim_, key));
    plot.x = {.name = key, .logarithmic = logarithmic, .from_zero = false};
    add_points(plot,
               [this, &key](std::size_t k) { return number_of(evaluations_[k].value("values", Json::object()), key); });
    std::string name = "design_" + key;
    for (char& c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    page_.add(figure_of(plot, name, "", ""));
  }

  void designs() {
    page_.section("designs", "All designs");
    std::vector<std::string> header{"design"};
    for (const Json& key : search_.at("over")) header.push_back(text(key, "key"));
    for (const std::string& name :
         {std::string("granules"), axis_, std::string("standard error"), std::string("status")})
      header.push_back(name);
    std::vector<std::vector<std::string>> rows;
    for (std::size_t k = 0; k < evaluations_.size(); ++k) {
      const Json& one = evaluations_[k];
      std::vector<std::string> row{fmt::format("{}{}", k + 1, is_best(k) ? " (best)" : "")};
      for (const Json& key : search_.at("over"))
        row.push_back(fmt::format("{:.6g}", number_of(one.value("values", Json::object()), text(key, "key"))));
      const double mean = number(one, "mean") * unit_.factor, spread = number(one, "standard_error") * unit_.factor;
      row.push_back(fmt::format("{:.0f}", number(one, "granules")));
      row.push_back(std::isfinite(mean) ? fmt::format("{:.5g}", mean) : "");
      row.push_back(std::isfinite(spread) ? fmt::format("{:.2g}", spread) : "");
      row.push_back(text(one, "status") + (text(one, "error").empty() ? "" : ": " + text(one, "error")));
      rows.push_back(std::move(row));
    }
    page_.add(table(header, rows));
  }

  const Json& search_;
  const Json& evaluations_;
  std::string aim_, axis_;
  ReadableUnit unit_;
  Page page_;
};

} // namespace

Page optimise_page(const fs::path& folder) {
  const fs::path file = folder / "optimise.json";
  const Json search = read_json(file, {"over", "evaluations"});
  try {
    return OptimisePage(search, folder).made();
  } catch (const Json::exception& error) {
    throw FileError(file.string() + ": is damaged: " + error.what());
  }
}

} // namespace grandamp::report
