// When a run records something.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace grandamp {

/// The steps nearest to multiples of an interval, each once, in order. What is due depends on the step alone, never on
/// what happened before, so that a run that goes on records what it would have recorded.
class OutputSchedule {
public:
  /// Never due.
  OutputSchedule() = default;
  /// `interval` and `time_step` in s. What was due before the step `from` is over.
  OutputSchedule(double interval, double time_step, std::int64_t from = 0)
      : steps_per_output_(interval / time_step),
        output_(std::max<std::int64_t>(0, std::llround(static_cast<double>(from) / steps_per_output_) - 2)) {
    next_ = step_of(output_);
    while (next_ < from) advance();
  }

  bool due(std::int64_t step) const noexcept { return step == next_; }
  void advance() {
    const std::int64_t last = next_;
    while (next_ == last) next_ = step_of(++output_);
  }

private:
  std::int64_t step_of(std::int64_t output) const {
    return std::llround(static_cast<double>(output) * steps_per_output_);
  }

  double steps_per_output_ = 0.0;
  std::int64_t output_ = 0;
  std::int64_t next_ = -1;
};

} // namespace grandamp
