#include "io/report.hpp"

#include "io/report_run.hpp"
#include "io/report_study.hpp"
#include "io/report_sweep.hpp"
#include "io/run.hpp"
#include "solver/errors.hpp"

namespace grandamp {

std::filesystem::path write_report(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) throw FileError(folder.string() + ": there is no such folder");
  if (fs::exists(folder / "study.json", ignored)) return report::study_page(folder).write(folder);
  if (fs::exists(folder / "sweep.json", ignored)) return report::sweep_page(folder).write(folder);
  if (fs::exists(folder / "optimise.json", ignored)) return report::optimise_page(folder).write(folder);
  if (fs::exists(folder / "scene.toml", ignored) || fs::exists(folder / "results.h5", ignored))
    return report::run_page(folder).write(folder);
  throw UsageError(folder.string() + ": holds nothing to report on: no run (results.h5), no sweep "
                                     "(sweep.json), no search (optimise.json) and no study (study.json)");
}

} // namespace grandamp
