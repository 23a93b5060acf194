// Where a run's time goes, phase by phase. Watches only: nothing that moves a granule depends on it.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace grandamp {

enum class Phase { sort, build, walls, pairs, motion, structure, output };

inline constexpr std::array<const char*, 7> phase_names{"sort",   "build",     "walls", "pairs",
                                                        "motion", "structure", "output"};

class Profile {
public:
  struct Event {
    Phase phase;
    std::uint32_t lane; ///< segment of the rows; 0 for what the whole run does
    double begin, end;  ///< s since the profile began
  };

  /// Lanes may be timed at the same time. Called before they are, whenever their number may have changed.
  void prepare(std::size_t lanes) {
    if (lanes_.size() < lanes) lanes_.resize(lanes);
  }

  template <class Work> void time(Phase phase, std::size_t lane, const Work& work) {
    const Clock::time_point begin = Clock::now();
    work();
    add(phase, lane, begin, Clock::now());
  }

  /// Seconds by phase, summed over lanes: with several threads more than the wall's.
  std::array<double, phase_names.size()> totals() const;
  /// The first of each lane (`most_events`), for a trace.
  std::vector<Event> events() const;

private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most_events = 20000;

  struct Lane {
    std::array<double, phase_names.size()> seconds{};
    std::vector<Event> events;
  };

  void add(Phase phase, std::size_t lane, Clock::time_point begin, Clock::time_point end);

  Clock::time_point origin_ = Clock::now();
  std::vector<Lane> lanes_{1};
};

/// Times the work if there is a profile, and just does it if there is none.
template <class Work> void timed(Profile* profile, Phase phase, std::size_t lane, const Work& work) {
  if (profile != nullptr)
    profile->time(phase, lane, work);
  else
    work();
}

} // namespace grandamp
