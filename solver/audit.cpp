#include "solver/audit.hpp"

#include <algorithm>
#include <unordered_set>

namespace grandamp {

void Audit::compare(const Granules& granules, const VerletList& list, const std::vector<Wall>& walls,
                    std::int64_t interval) {
  const std::uint32_t count = granules.count();
  std::unordered_set<std::uint64_t> listed;
  listed.reserve(2 * list.candidates());
  const auto key = [](std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  };
  for (const Segment& segment : list.segments()) {
    for (const PairList* pairs : {&segment.inner, &segment.boundary})
      for (std::size_t k = 0; k < pairs->count(); ++k)
        listed.insert(key(pairs->data()[k].first(), pairs->data()[k].second()));
    for (std::size_t w = 0; w < walls.size(); ++w)
      for (std::size_t k = 0; k < segment.walls[w].count; ++k)
        listed.insert(key(segment.walls[w].granules[k], count + 2 + static_cast<std::uint32_t>(w)));
  }

  std::set<std::pair<std::uint32_t, std::uint32_t>> now;
  for (std::uint32_t i = 0; i < count; ++i) {
    const kernels::PositionRow a = granules.position[i];
    for (std::uint32_t j = i + 1; j < count; ++j) {
      const kernels::PositionRow& b = granules.position[j];
      const double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z, reach = a.radius + b.radius;
      if (x * x + y * y + z * z < reach * reach && !listed.contains(key(i, j)))
        now.insert(std::minmax(granules.id[i], granules.id[j]));
    }
    for (std::size_t w = 0; w < walls.size(); ++w)
      if (distance_inside(walls[w], a) < a.radius &&
          !listed.contains(key(i, count + 2 + static_cast<std::uint32_t>(w))))
        now.insert({granules.id[i], count + static_cast<std::uint32_t>(w)});
  }
  ++audited;
  missed_pair_steps += static_cast<std::int64_t>(now.size()) * interval;
  for (const auto& contact : now) missed += unlisted_.contains(contact) ? 0 : 1;
  unlisted_ = std::move(now);
}

} // namespace grandamp
