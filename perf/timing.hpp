// Clocks and memory of this process, and what callgrind is told.
#pragma once

#include <cstddef>

namespace grandamp::perf {

/// Of this process, all its threads, s.
double processor_seconds();
double wall_seconds();

/// Memory in use now, and the most there was, bytes.
std::size_t resident_bytes();
std::size_t peak_resident_bytes();

/// Under valgrind --tool=callgrind --collect-atstart=no only what lies between two of these is counted.
void toggle_instruction_count();

/// Processor and wall time of a stretch of the program.
class Stopwatch {
public:
  Stopwatch() : processor_(processor_seconds()), wall_(wall_seconds()) {}
  double processor() const { return processor_seconds() - processor_; }
  double wall() const { return wall_seconds() - wall_; }

private:
  double processor_, wall_;
};

} // namespace grandamp::perf
