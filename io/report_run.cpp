#include "io/report_run.hpp"

#include "io/report_histories.hpp"
#include "io/report_verdict.hpp"
#include "io/scene_file.hpp"
#include "io/text_file.hpp"
#include "solver/errors.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>

namespace grandamp::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file.string() + ": cannot read the file");
  return {std::istreambuf_iterator<char>(stream), {}};
}

Json summary_of(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return nullptr;
  Json summary = Json::parse(content_of(file), nullptr, false);
  if (!summary.is_object()) throw FileError(file.string() + ": is damaged: not a JSON object");
  return summary;
}

std::string time_of(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  if (error) return "";
  const auto system = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::file_clock::to_sys(written));
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(system)));
}

} // namespace

double number(const Json& json, std::string_view path) {
  const Json::json_pointer pointer("/" + std::string(path));
  if (!json.is_object() || !json.contains(pointer)) return not_known;
  const Json& value = json.at(pointer);
  return value.is_number() ? value.get<double>() : not_known;
}

std::string text(const Json& json, std::string_view path) {
  const Json::json_pointer pointer("/" + std::string(path));
  if (!json.is_object() || !json.contains(pointer)) return "";
  const Json& value = json.at(pointer);
  return value.is_string() ? value.get<std::string>() : "";
}

const std::vector<double>* RunFacts::column(std::string_view name) const {
  const auto found = std::find(history.names.begin(), history.names.end(), name);
  return found == history.names.end() ? nullptr
                                      : &history.columns[static_cast<std::size_t>(found - history.names.begin())];
}

double RunFacts::end() const {
  const std::vector<double>& time = *column("time");
  return time.empty() ? 0.0 : time.back();
}

std::array<double, 2> RunFacts::window() const {
  if (plan && scene->structure) return plan->window;
  return {number(summary, "structure/window/0"), number(summary, "structure/window/1")};
}

double RunFacts::forcing_frequency() const {
  if (!scene || scene->excitation.kind == ExcitationKind::none || !(scene->excitation.frequency > 0.0))
    return not_known;
  return scene->excitation.frequency;
}

RunFacts read_run(const fs::path& folder) {
  RunFacts run;
  run.folder = folder;
  std::error_code ignored;
  if (!fs::exists(folder / "results.h5", ignored))
    throw FileError((folder / "results.h5").string() +
                    ": there are no results; the run was stopped while its granules were poured, or still pours them");
  run.summary = summary_of(folder / "summary.json");
  run.history = read_history(folder / "results.h5");
  if (run.column("time") == nullptr || run.column("time")->empty() || run.column("displacement") == nullptr)
    throw FileError((folder / "results.h5").string() + ": holds no histories");
  run.written = time_of(folder / "results.h5");
  run.scene_text = read_stored_scene(folder / "results.h5");
  // A scene of another version is still shown as text, and its results are still results.
  try {
    run.scene = read_scene_text(run.scene_text, (folder / "scene.toml").string()).scene;
    run.plan = make_plan(*run.scene);
  } catch (const std::runtime_error&) {
    run.scene.reset();
  }
  return run;
}

Page run_page(const fs::path& folder) {
  const RunFacts run = read_run(folder);
  std::string title = text(run.summary, "title");
  if (title.empty() && run.scene) title = run.scene->title;
  if (title.empty()) title = fs::absolute(folder).lexically_normal().filename().string();
  if (title.empty()) title = "A run";
  const std::string status = run.summary.is_null() ? "not finished" : text(run.summary, "status");
  Page page(title, fmt::format("A run of grandamp, {}; results of {}", status, run.written));
  add_verdict(page, run);
  add_key_numbers(page, run);
  add_description(page, run);
  add_granules(page, run);
  HistoryBook book(*run.column("time"));
  add_histories(page, run, book);
  add_amplitudes(page, run);
  add_energy(page, run, book);
  book.close(page);
  if (std::isfinite(run.forcing_frequency())) page.facts()["period"] = 1.0 / run.forcing_frequency();
  add_search_and_time(page, run);
  page.section("scene", "The scene, as run");
  page.add(fmt::format("<pre tabindex=\"0\">{}</pre>\n", escaped(run.scene_text)));
  return page;
}

} // namespace grandamp::report
