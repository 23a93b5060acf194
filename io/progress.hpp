// What a run shows while it goes: one updating line on a terminal, a line a minute in a log.
#pragma once

#include "io/run.hpp"

#include <chrono>
#include <string>

namespace grandamp {

/// "3 s", "4 min 10 s", "2 h 05 min".
std::string readable_seconds(double seconds);
/// The line itself: simulated and total time, rate, wall time, time left, amplitude.
std::string progress_line(const RunProgress& progress);

/// Writes to standard error.
class ProgressPrinter {
public:
  enum class Style { none, terminal, log };

  explicit ProgressPrinter(Style style) : style_(style) {}
  /// terminal if standard error is one, log otherwise.
  static Style style_here();

  void show(const RunProgress& progress);
  /// Takes the line off the terminal, so that a message has it to itself.
  void clear();

private:
  Style style_;
  bool on_screen_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace grandamp
