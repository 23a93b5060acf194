#include "io/study.hpp"
#include "io/commands/commands.hpp"
#include "io/progress.hpp"
#include "io/run.hpp"
#include "io/signals.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
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

/// One updating line on a terminal, a line every half minute in a log.
class StudyProgressPrinter {
public:
  explicit StudyProgressPrinter(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}
  void show(std::size_t done, std::size_t all, double seconds, double left) {
    if (quiet_) return;
    std::string line = fmt::format("{} of {} runs, {}", done, all, readable_seconds(seconds));
    if (left >= 0.0 && done < all) line += ", about " + readable_seconds(left) + " left";
    if (terminal_) {
      fmt::print(stderr, "\r{}\x1b[K", line);
      std::fflush(stderr);
    } else if (seconds - told_ >= 30.0) {
      spdlog::info("{}", line);
      told_ = seconds;
    }
  }
  void clear() const {
    if (quiet_ || !terminal_) return;
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
  }

private:
  bool quiet_, terminal_;
  double told_ = 0.0;
};

} // namespace

int study_command(const StudyArguments& arguments) {
  require_isa(arguments.isa);
  StudyOptions options;
  options.error = error_of(arguments.error);
  const SceneDocument document = read_scene(arguments.scene, arguments.overrides);
  tell_notes(arguments.scene, document.notes);
  std::filesystem::path folder = arguments.folder;
  if (folder.empty()) folder = arguments.scene.stem();
  options.seeds = arguments.seeds;
  options.vary = arguments.vary;
  options.threads = arguments.threads;
  options.isa = arguments.isa;
  options.max_wall = arguments.max_wall;
  options.force = arguments.force;
  StudyProgressPrinter printer(arguments.quiet);
  options.tell = [](const std::string& line) { spdlog::info("{}", line); };
  options.progress = [&](std::size_t done, std::size_t all, double seconds, double left) {
    printer.show(done, all, seconds, left);
  };
  options.stop_requested = SignalWatch::stop_requested;

  const SignalWatch watch;
  StudyResult result;
  try {
    result = study_accuracy(document, arguments.scene.string(), folder, options);
  } catch (...) {
    printer.clear();
    throw;
  }
  printer.clear();
  if (arguments.json)
    fmt::print("{}", result.json);
  else if (!result.paragraph.empty())
    fmt::print("{}\n", result.paragraph);
  if (result.interrupted) {
    spdlog::warn("interrupted; the same command goes on with what is left; so far: {}", (folder / "study.md").string());
    return exit_interrupted;
  }
  spdlog::info("results in {}", folder.string());
  return exit_done;
}

} // namespace grandamp
