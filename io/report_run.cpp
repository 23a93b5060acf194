#include "io/report_run.hpp"

#include "io/report_histories.hpp"
#include "io/report_verdict.hpp"
#include "io/scene_file.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp::report {

namespace fs = std::filesystem;

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
  if (fs::exists(folder / "summary.json", ignored)) run.summary = read_json(folder / "summary.json");
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
  const std::string title = run.summary.is_null() && run.scene && !run.scene->title.empty()
                                ? run.scene->title
                                : title_of(run.summary, folder);
  const std::string status = run.summary.is_null() ? "not finished" : text(run.summary, "status");
  Page page(title, fmt::format("A run of grandamp, {}; results of {}", status, run.written));
  add_verdict(page, run);
  add_key_numbers(page, run);
  add_description(page, run);
  add_granules(page, run);
  HistoryBook book(*run.column("time"));
  add_histories(page, run, book);
  add_amplitudes(page, run);
  add_spectrum(page, run);
  add_energy(page, run, book);
  book.close(page);
  if (std::isfinite(run.forcing_frequency())) page.facts()["period"] = 1.0 / run.forcing_frequency();
  add_search_and_time(page, run);
  page.section("scene", "The scene, as run");
  page.add(fmt::format("<pre tabindex=\"0\">{}</pre>\n", escaped(run.scene_text)));
  return page;
}

} // namespace grandamp::report
