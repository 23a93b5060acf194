#include "solver/profile.hpp"

#include <algorithm>

namespace grandamp {

void Profile::add(Phase phase, std::size_t lane, Clock::time_point begin, Clock::time_point end) {
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  Lane& to = lanes_[lane];
  to.seconds[static_cast<std::size_t>(phase)] += seconds(end - begin);
  if (to.events.size() < most_events)
    to.events.push_back({phase, static_cast<std::uint32_t>(lane), seconds(begin - origin_), seconds(end - origin_)});
}

std::array<double, phase_names.size()> Profile::totals() const {
  std::array<double, phase_names.size()> sum{};
  for (const Lane& lane : lanes_)
    for (std::size_t phase = 0; phase < sum.size(); ++phase) sum[phase] += lane.seconds[phase];
  return sum;
}

std::vector<Profile::Event> Profile::events() const {
  std::vector<Event> all;
  for (const Lane& lane : lanes_) all.insert(all.end(), lane.events.begin(), lane.events.end());
  std::sort(all.begin(), all.end(), [](const Event& a, const Event& b) { return a.begin < b.begin; });
  return all;
}

} // namespace grandamp
