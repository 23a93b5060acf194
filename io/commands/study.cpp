#include "io/study.hpp"
#include "io/commands/case_command.hpp"
#include "io/run.hpp"

#include <spdlog/spdlog.h>

#include <cstdlib>

namespace grandamp {
namespace {

/// "1%", "1 %" or "0.01".
double error_of(const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  std::string unit(end);
  std::erase(unit, ' ');
  if (unit == "%") value /= 100.0;
  if (end == text.c_str() || (!unit.empty() && unit != "%") || !(value > 0.0 && value <= 0.5))
    throw UsageError("--error " + text +
                     ": not an error; allowed: above 0 and at most 0.5, or with a percent sign, 50%");
  return value;
}

} // namespace

int study_command(const StudyArguments& arguments) {
  StudyOptions options;
  options.error = error_of(arguments.error);
  options.vary = arguments.vary;
  CaseCommand command(arguments);
  const StudyResult result = command.run(options, study_accuracy);
  const std::filesystem::path& folder = command.folder();
  if (arguments.json)
    tell(result.json);
  else if (!result.paragraph.empty())
    tell(result.paragraph + "\n");
  if (result.interrupted) {
    spdlog::warn("interrupted; the same command goes on with what is left; so far: {}", (folder / "study.md").string());
    return exit_interrupted;
  }
  spdlog::info("results in {}", folder.string());
  return exit_done;
}

} // namespace grandamp
