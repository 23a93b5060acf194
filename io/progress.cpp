#include "io/progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grandamp {
namespace {

/// In place of the line before. A terminal that went away is no reason to end a run: failures are not looked at.
void show_line(const std::string& line) {
  const std::string text = "\r" + line + "\x1b[K";
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

} // namespace

std::string readable_seconds(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 1.0) return fmt::format("{:.2g} s", std::max(seconds, 0.0));
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  if (seconds >= 1e9) return "decades";
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  if (whole < 48 * 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  return fmt::format("{} d {} h", whole / 86400, whole / 3600 % 24);
}

std::string progress_line(const RunProgress& progress) {
  if (progress.pouring) {
    return fmt::format("pouring: {:.3f} s, kinetic energy {:.1e} m g d (rest below 1e-6)", progress.time,
                       progress.pouring_energy);
  }
  const double done = progress.duration > 0.0 ? progress.time / progress.duration : 1.0;
  std::string line = fmt::format("{:.4g} of {:.4g} s ({:.1f} %)", progress.time, progress.duration, 100.0 * done);
  if (progress.rate > 0.0) line += fmt::format(", {:.1f} M granule-steps/s", progress.rate * 1e-6);
  line += ", " + readable_seconds(progress.wall_time);
  if (done > 0.0 && done < 1.0) {
    line += ", " + readable_seconds(progress.wall_time * (1.0 - done) / done) + " left";
  }
  if (progress.amplitude) line += fmt::format(", amplitude {:.3f} mm", 1e3 * *progress.amplitude);
  return line;
}

ProgressPrinter::Style ProgressPrinter::style_here() {
  return isatty(STDERR_FILENO) == 1 ? Style::terminal : Style::log;
}

void ProgressPrinter::show(const RunProgress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (style_ == Style::terminal) {
    if (on_screen_ && now - last_ < std::chrono::milliseconds(90)) return;
    show_line(progress_line(progress));
    on_screen_ = true;
    last_ = now;
  } else if (style_ == Style::log && now - last_ >= std::chrono::minutes(1)) {
    spdlog::info("{}", progress_line(progress));
    last_ = now;
  }
}

void ProgressPrinter::clear() {
  if (!on_screen_) return;
  show_line("");
  on_screen_ = false;
}

} // namespace grandamp
