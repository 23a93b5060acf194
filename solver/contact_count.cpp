#include "solver/contact_count.hpp"

namespace grandamp {

std::vector<std::int32_t> contacts_by_id(const Granules& granules, const VerletList& list,
                                         const std::vector<Wall>& walls) {
  std::vector<std::int32_t> contacts(granules.count(), 0);
  for (const Segment& segment : list.segments()) {
    for (const PairList* pairs : {&segment.inner, &segment.boundary})
      for (std::size_t k = 0; k < pairs->count(); ++k) {
        const std::uint32_t i = pairs->data()[k].first(), j = pairs->data()[k].second();
        if (i >= granules.count() || j >= granules.count()) continue; // padding
        const kernels::PositionRow &a = granules.position[i], &b = granules.position[j];
        const double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z, reach = a.radius + b.radius;
        if (x * x + y * y + z * z >= reach * reach) continue;
        ++contacts[granules.id[i]];
        ++contacts[granules.id[j]];
      }
    for (std::size_t w = 0; w < walls.size(); ++w)
      for (std::size_t k = 0; k < segment.walls[w].count; ++k) {
        const std::uint32_t i = segment.walls[w].granules[k];
        if (distance_inside(walls[w], granules.position[i]) < granules.position[i].radius) ++contacts[granules.id[i]];
      }
  }
  return contacts;
}

} // namespace grandamp
