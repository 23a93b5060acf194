#include "io/study.hpp"

#include "io/progress.hpp"
#include "io/run.hpp"
#include "io/study_report.hpp"
#include "io/text_file.hpp"
#include "io/version.hpp"
#include "kernels/dispatch.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>

namespace grandamp {

namespace {

namespace fs = std::filesystem;

/// The folder of a study: nothing else may be in it, or a study of the same scene by the same program.
class StudyFolder {
public:
  StudyFolder(fs::path folder, const std::string& identity, bool force) : folder_(std::move(folder)) {
    std::error_code error;
    const fs::file_status status = fs::status(folder_, error);
    if (fs::exists(status) && !fs::is_directory(status))
      throw FileError(folder_.string() + ": is a file, not a folder; choose another with -o");
    const bool mine = fs::exists(folder_ / "study.toml", error);
    if (mine && !force && content(folder_ / "study.toml") != identity)
      throw UsageError(folder_.string() +
                       ": holds a study of another scene, or by another version, instruction set or "
                       "number of threads; choose another folder with -o, or replace it with --force");
    if (!mine && !force && fs::exists(status) && !fs::is_empty(folder_, error))
      throw UsageError(folder_.string() +
                       ": holds something that is no study; choose another folder with -o, or add to "
                       "it with --force");
    if (mine && force) fs::remove_all(folder_ / "cases", error);
    fs::create_directories(folder_ / "cases", error);
    if (error) throw FileError(folder_.string() + ": cannot make the folder: " + error.message());
    replace_file(folder_ / "study.toml", identity);
  }

private:
  static std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path folder_;
};

void tell_plan(const StudySettings& settings, const StudyOptions& options, const StudyThreads& threads,
               std::size_t granules) {
  if (!options.tell) return;
  double seconds = 0.0;
  for (const StudySetting& setting : settings.settings)
    seconds += options.seeds * setting.seconds +
               (setting.audited ? std::min(study_audit_seconds, 20.0 * setting.seconds) : 0.0);
  seconds /= threads.cases == 1 ? 1.0 + 0.8 * (threads.each - 1) : threads.cases;
  options.tell(
      fmt::format("{} settings, {} seed{}: {} runs of {} granules, {} at a time, about {} in all (within a factor "
                  "of three; pouring not counted)",
                  settings.settings.size(), options.seeds, options.seeds == 1 ? "" : "s",
                  settings.settings.size() * static_cast<std::size_t>(options.seeds), granules, threads.cases,
                  readable_seconds(seconds)));
  for (const std::string& one : settings.left_out) options.tell("left out: " + one);
}

} // namespace

StudyResult study_accuracy(const SceneDocument& document, const std::string& name, const fs::path& folder,
                           const StudyOptions& options) {
  std::size_t granules = 0;
  for (const Population& population : document.scene.populations) granules += population.count;
  if (granules == 0)
    throw SceneError(Problem{"granules", "", "no granules: there is no contact whose accuracy could be studied",
                             "at least one population with a count above 0"});
  make_located_plan(document);
  const std::string isa = options.isa.empty() ? kernels::name(kernels::best_available()) : options.isa;
  const StudySettings settings = study_settings(document, name, options.vary, isa);
  const StudyThreads threads = study_threads(granules, options.threads);
  const StudyFolder files(folder,
                          fmt::format("# grandamp {} study accuracy, {}, {} at a time, {} threads each\n{}", version(),
                                      isa, threads.cases, threads.each, document.text),
                          options.force);
  tell_plan(settings, options, threads, granules);

  const StudyCases cases = run_cases(document, name, settings, folder, options);
  const StudyTable table = study_table(settings, cases);
  StudyReport report;
  report.table = &table;
  report.settings = &settings;
  report.title = document.scene.title.empty() ? name : document.scene.title;
  report.error = options.error;
  report.done = cases.done.size();
  report.planned = cases.planned;
  report.threads = threads;
  report.isa = isa;
  StudyResult result;
  result.interrupted = cases.interrupted;
  result.paragraph = report.paragraph();
  result.json = report.json();
  replace_file(folder / "study.csv", report.csv());
  replace_file(folder / "study.json", result.json);
  replace_file(folder / "study.md", report.markdown());
  write_study_pictures(report, folder);
  return result;
}

} // namespace grandamp
