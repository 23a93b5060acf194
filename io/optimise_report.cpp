#include "io/optimise_report.hpp"

#include "io/case_pool.hpp"
#include "io/json.hpp"
#include "io/svg_plot.hpp"
#include "io/sweep_table.hpp"
#include "io/version.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grandamp {

namespace {

std::string with_error(const MeanAndError& value) {
  return std::isnan(value.error) ? fmt::format("{:.4g} (scatter not known)", value.mean)
                                 : fmt::format("{:.4g} ± {:.2g}", value.mean, value.error);
}

std::string values_text(const CasePoint& design, const std::vector<FreeKey>& keys) {
  std::string text;
  for (std::size_t i = 0; i < keys.size(); ++i)
    text += fmt::format("{}{} = {}", i > 0 ? ", " : "", keys[i].key, design.values[i].text);
  return text;
}

Json evaluation_json(const Evaluation& one, std::size_t index, const std::vector<FreeKey>& keys) {
  Json json{{"index", index}, {"part", one.part}, {"status", one.good() ? "done" : "failed"}, {"error", one.error}};
  for (std::size_t i = 0; i < keys.size(); ++i) json["values"][keys[i].key] = *one.design.values[i].number;
  json["overrides"] = one.design.overrides;
  json["granules"] = one.design.granules;
  json["granule_mass"] = one.design.granule_mass;
  json["mean"] = json_number(one.result.mean);
  json["standard_error"] = json_number(one.result.error);
  json["all_seeds"] = {
      {"count", one.all.count}, {"mean", json_number(one.all.mean)}, {"standard_error", json_number(one.all.error)}};
  json["best_so_far"] = json_number(one.best_so_far);
  json["runs"] = Json::array();
  for (std::size_t k = 0; k < one.runs.size(); ++k)
    json["runs"].push_back({{"seed", one.runs[k].seed},
                            {"status", name(one.runs[k].state.status)},
                            {"folder", "runs/" + one.runs[k].job.folder.filename().string()},
                            {"value", json_number(k < one.values.size() ? one.values[k] : std::nan(""))}});
  return json;
}

PlotPoint point_of(double x, const MeanAndError& value) {
  const double error = std::isnan(value.error) ? 0.0 : value.error;
  return {.x = x, .y = value.mean, .low = value.mean - error, .high = value.mean + error};
}

} // namespace

std::string OptimiseReport::paragraph() const {
  const Evaluation* best = search->best();
  if (best == nullptr) return "";
  const std::string what = fmt::format("{} {}", maximise ? "Greatest" : "Least", number);
  std::string text = fmt::format("{}: {} with {} ({} granules, {} seeds)", what, with_error(best->all),
                                 values_text(best->design, search->keys()), best->design.granules, best->all.count);
  if (const Evaluation* scene = search->scene(); scene != nullptr && scene != best) {
    const MeanAndError gain = DesignSearch::difference(*scene, *best);
    text += fmt::format("; the scene as it is: {}, a difference of {}", with_error(scene->all), with_error(gain));
    if (!std::isnan(gain.error) && std::abs(gain.mean) <= 2.0 * gain.error) text += ", which may be chance";
  } else if (scene != nullptr) {
    text += "; that is the scene as it is";
  }
  std::size_t others = 0, runs = 0;
  for (const Evaluation& one : search->evaluations()) {
    runs += one.runs.size();
    if (&one == best || !one.good() || one.values.empty()) continue;
    const MeanAndError behind = DesignSearch::difference(*best, one);
    if (!std::isnan(behind.error) && std::abs(behind.mean) <= 2.0 * behind.error) ++others;
  }
  if (others > 0) text += fmt::format("; {} other design{} cannot be told from it", others, others == 1 ? "" : "s");
  text += fmt::format(". {} designs, {} runs", search->evaluations().size(), runs);
  if (!search->reason().empty()) text += "; " + search->reason();
  return text + ". Errors: one standard error.";
}

std::string OptimiseReport::csv() const {
  std::string text = "evaluation,part";
  for (const FreeKey& key : search->keys()) text += ',' + csv_text(key.key);
  text += ",granules,granule_mass,status,mean,standard_error,best_so_far,all_seeds,all_mean,all_standard_error,error\n";
  for (std::size_t k = 0; k < search->evaluations().size(); ++k) {
    const Evaluation& one = search->evaluations()[k];
    text += fmt::format("{},{}", k, one.part);
    for (const VaryValue& value : one.design.values) text += ',' + value.text;
    text += fmt::format(",{},{},{},{},{},{},{},{},{},{}\n", one.design.granules, one.design.granule_mass,
                        one.good() ? "done" : "failed", csv_number(one.result.mean), csv_number(one.result.error),
                        csv_number(one.best_so_far), one.all.count, csv_number(one.all.mean), csv_number(one.all.error),
                        csv_text(one.error));
  }
  return text;
}

std::string OptimiseReport::json() const {
  Json json{{"title", title}, {"version", version()}, {"isa", isa}};
  json["status"] = search->reason().empty() ? "incomplete" : "done";
  json["reason"] = search->reason();
  json["text"] = paragraph();
  json[maximise ? "maximise" : "minimise"] = number;
  json["over"] = Json::array();
  for (const FreeKey& key : search->keys())
    json["over"].push_back({{"key", key.key}, {"from", key.low}, {"to", key.high}, {"logarithmic", key.logarithmic}});
  json["keep"] = keep_total_mass ? Json("total_mass") : Json(nullptr);
  json["seeds"] = seeds;
  const std::vector<Evaluation>& all = search->evaluations();
  const Evaluation *best = search->best(), *scene = search->scene();
  json["best"] = best != nullptr ? Json(best - all.data()) : Json(nullptr);
  json["scene_as_it_is"] = scene != nullptr ? Json(scene - all.data()) : Json(nullptr);
  if (best != nullptr && scene != nullptr && best != scene) {
    const MeanAndError gain = DesignSearch::difference(*scene, *best);
    json["difference"] = {{"mean", json_number(gain.mean)}, {"standard_error", json_number(gain.error)}};
  }
  json["evaluations"] = Json::array();
  for (std::size_t k = 0; k < all.size(); ++k)
    json["evaluations"].push_back(evaluation_json(all[k], k, search->keys()));
  json["scene"] = document->text;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void OptimiseReport::write_pictures(const std::filesystem::path& folder) const {
  const std::vector<Evaluation>& all = search->evaluations();
  const Evaluation* best = search->best();
  if (best == nullptr) return;
  const auto is_shown = [](const Evaluation& one) { return one.good() && !one.values.empty(); };
  Plot path;
  path.title = "The path to the best design; bars: standard error";
  path.x = {"evaluation", false, false};
  path.y = {number, false, false};
  PlotSeries so_far{.name = "best so far", .colour = "#9bb7d4", .line = true, .dots = false, .width = 4.0};
  PlotSeries start{.name = "start", .colour = "#888888"}, tried{.name = "search", .colour = "#1f4e79"},
      chosen{.name = "best, all seeds", .colour = "#d32f2f"};
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (std::isfinite(all[k].best_so_far))
      so_far.points.push_back({.x = static_cast<double>(k), .y = all[k].best_so_far});
    if (is_shown(all[k]))
      (all[k].part == "search" ? tried : start).points.push_back(point_of(static_cast<double>(k), all[k].result));
  }
  chosen.points.push_back(point_of(static_cast<double>(best - all.data()), best->all));
  path.series = {so_far, start, tried, chosen};
  replace_shared_file(folder / "optimise.svg", path.svg());

  for (std::size_t i = 0; i < search->keys().size(); ++i) {
    Plot plot;
    plot.title = "Designs tried; bars: standard error";
    plot.x = {search->keys()[i].key, search->keys()[i].logarithmic, false};
    plot.y = {number, false, false};
    PlotSeries designs{.name = "designs", .colour = "#1f4e79"},
        one_best{.name = "best, all seeds", .colour = "#d32f2f"};
    for (const Evaluation& one : all)
      if (is_shown(one)) designs.points.push_back(point_of(*one.design.values[i].number, one.all));
    one_best.points.push_back(point_of(*best->design.values[i].number, best->all));
    plot.series = {designs, one_best};
    replace_shared_file(folder / fmt::format("design_{}.svg", i + 1), plot.svg());
  }
}

} // namespace grandamp
