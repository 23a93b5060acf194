#include "io/sweep_table.hpp"

#include "io/json.hpp"
#include "io/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp {

namespace {

Json value_json(const VaryValue& value) {
  return value.number ? Json(*value.number) : Json(value.text);
}

Json run_json(const CaseRun& run) {
  Json json{{"seed", run.seed},
            {"status", name(run.state.status)},
            {"folder", "runs/" + run.job.folder.filename().string()},
            {"exit_status", run.state.exit_status},
            {"error", run.state.error}};
  Json& numbers = json["numbers"] = Json::object();
  for (const std::string& one : run.numbers.names()) numbers[one] = json_number(run.numbers.at(one));
  return json;
}

} // namespace

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted += '"';
}

std::string csv_number(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

const MeanAndError* PointStatistics::find(const std::string& name) const {
  const auto found = numbers.find(name);
  return found != numbers.end() ? &found->second : nullptr;
}

bool PointStatistics::steady() const {
  const MeanAndError* steady = find("structure.steady");
  return steady != nullptr && steady->mean == 1.0;
}

std::string PointStatistics::status(std::size_t seeds) const {
  if (done == seeds) return "done";
  if (failed == seeds) return "failed";
  return done + failed == seeds ? "partly failed" : "incomplete";
}

std::size_t SweepTable::count(CaseStatus status) const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [status](const CaseRun& run) { return run.state.status == status; }));
}

void SweepTable::sum_up() {
  results.assign(points.size(), {});
  names.clear();
  for (std::size_t point = 0; point < points.size(); ++point) {
    PointStatistics& result = results[point];
    std::map<std::string, std::vector<double>> values;
    for (std::size_t seed = 0; seed < seeds; ++seed) {
      const CaseRun& one = run(point, seed);
      result.done += one.state.status == CaseStatus::done ? 1 : 0;
      result.failed += one.state.status == CaseStatus::failed ? 1 : 0;
      for (const std::string& number : one.numbers.names()) {
        values[number].push_back(one.numbers.at(number));
        if (is_of_interest(number) && std::find(names.begin(), names.end(), number) == names.end())
          names.push_back(number);
      }
    }
    for (const auto& [number, list] : values) result.numbers[number] = mean_of(list);
  }
}

std::string SweepTable::csv() const {
  std::string text;
  for (const VariedKey& key : keys) text += csv_text(key.key) + ',';
  text += "granules,granule_mass,seeds,status";
  for (const std::string& one : names) text += fmt::format(",{0},{0}_error", one);
  text += ",error\n";
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const VaryValue& value : points[k].values) text += csv_text(value.text) + ',';
    text += fmt::format("{},{},{},{}", points[k].granules, points[k].granule_mass, results[k].done,
                        results[k].status(seeds));
    for (const std::string& one : names) {
      const MeanAndError* number = results[k].find(one);
      text += number != nullptr ? ',' + csv_number(number->mean) + ',' + csv_number(number->error) : ",,";
    }
    std::string error;
    for (std::size_t seed = 0; seed < seeds && error.empty(); ++seed) error = run(k, seed).state.error;
    text += ',' + csv_text(error) + '\n';
  }
  return text;
}

std::string SweepTable::runs_csv() const {
  std::string text;
  for (const VariedKey& key : keys) text += csv_text(key.key) + ',';
  text += "seed,granules,granule_mass,folder,status";
  for (const std::string& one : names) text += ',' + one;
  text += ",error\n";
  for (const CaseRun& run : runs) {
    const CasePoint& point = points[run.point];
    for (const VaryValue& value : point.values) text += csv_text(value.text) + ',';
    text += fmt::format("{},{},{},runs/{},{}", run.seed, point.granules, point.granule_mass,
                        run.job.folder.filename().string(), name(run.state.status));
    for (const std::string& one : names) text += ',' + csv_number(run.numbers.at(one));
    text += ',' + csv_text(run.state.error) + '\n';
  }
  return text;
}

std::string SweepTable::json() const {
  Json json{{"title", title}, {"version", version()}, {"isa", isa}};
  const std::size_t done = count(CaseStatus::done), failed = count(CaseStatus::failed);
  json["status"] = done == runs.size() ? "done" : done + failed == runs.size() ? "partly failed" : "incomplete";
  json["runs"] = {{"planned", runs.size()}, {"done", done}, {"failed", failed}};
  json["keep"] = keep_total_mass ? Json("total_mass") : Json(nullptr);
  json["vary"] = Json::array();
  for (const VariedKey& key : keys) {
    Json values = Json::array();
    for (const VaryValue& value : key.values) values.push_back(value_json(value));
    json["vary"].push_back({{"key", key.key}, {"values", values}});
  }
  json["seeds"] = Json::array();
  for (std::size_t seed = 0; seed < seeds && !runs.empty(); ++seed) json["seeds"].push_back(run(0, seed).seed);
  json["numbers"] = names;
  json["points"] = Json::array();
  for (std::size_t k = 0; k < points.size(); ++k) {
    Json point{{"index", k}, {"status", results[k].status(seeds)}};
    for (std::size_t i = 0; i < keys.size(); ++i) point["values"][keys[i].key] = value_json(points[k].values[i]);
    point["overrides"] = points[k].overrides;
    point["granules"] = points[k].granules;
    point["granule_mass"] = points[k].granule_mass;
    point["done"] = results[k].done;
    if (points[k].structure) point["steady"] = results[k].steady();
    Json mean = Json::object(), error = Json::object();
    for (const std::string& one : names)
      if (const MeanAndError* found = results[k].find(one)) {
        mean[one] = json_number(found->mean);
        error[one] = json_number(found->error);
      }
    point["mean"] = std::move(mean);
    point["error"] = std::move(error);
    point["runs"] = Json::array();
    for (std::size_t seed = 0; seed < seeds; ++seed) point["runs"].push_back(run_json(run(k, seed)));
    json["points"].push_back(std::move(point));
  }
  json["pictures"] = pictures;
  json["scene"] = scene_text;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace grandamp
