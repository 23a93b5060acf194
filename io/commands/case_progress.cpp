#include "io/commands/case_progress.hpp"

#include "io/progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>

namespace grandamp {

CaseProgressPrinter::CaseProgressPrinter(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

void CaseProgressPrinter::show(const CaseProgress& progress) {
  if (quiet_ || progress.all == 0) return;
  const bool due = terminal_ ? progress.seconds - shown_ >= 0.09 : progress.seconds - told_ >= 30.0;
  if (progress.seconds < shown_) { // another batch
    shown_ = -1.0;
    told_ = 0.0;
  }
  if (!due) return;
  std::string line = fmt::format("{}{} of {} runs, {} at work, {}", head_, progress.done, progress.all,
                                 progress.running, readable_seconds(progress.seconds));
  if (progress.left >= 0.0 && progress.done < progress.all)
    line += ", about " + readable_seconds(progress.left) + " left";
  if (terminal_) {
    fmt::print(stderr, "\r{}\x1b[K", line);
    std::fflush(stderr);
    shown_ = progress.seconds;
    on_screen_ = true;
  } else {
    spdlog::info("{}", line);
    told_ = progress.seconds;
  }
}

void CaseProgressPrinter::clear() {
  if (!on_screen_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  on_screen_ = false;
}

} // namespace grandamp
