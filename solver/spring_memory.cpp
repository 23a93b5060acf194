#include "solver/spring_memory.hpp"

#include <algorithm>

namespace grandamp {

namespace {

using kernels::RowPair;
using kernels::SpringRow;

/// Steps as the rows mark them. Rows are wiped at every rebuild, so that a number cannot come round again.
std::uint32_t mark_of(std::int64_t step) {
  return static_cast<std::uint32_t>(step);
}

SpringRow turned_round(SpringRow row) {
  for (double& force : row.force) force = -force;
  return row;
}

void take(std::vector<LoadedSpring>& to, const SpringMemory::Rows& rows, const PairList& pairs,
          const Granules& granules, std::uint32_t mark) {
  const std::size_t count = std::min(pairs.count(), rows.row.size());
  for (std::size_t k = 0; k < count; ++k) {
    const RowPair pair = pairs.data()[k];
    if (rows.touched[k] != mark || pair.first() >= granules.count()) continue;
    const std::uint32_t first = granules.id[pair.first()], second = granules.id[pair.second()];
    to.push_back(first < second ? LoadedSpring{first, second, rows.row[k]}
                                : LoadedSpring{second, first, turned_round(rows.row[k])});
  }
}

/// Loaded springs by their lower id.
class Register {
public:
  Register(const std::vector<LoadedSpring>& springs, std::uint32_t granules)
      : springs_(springs.size()), start_(std::size_t{granules} + 1, 0) {
    for (const LoadedSpring& spring : springs) ++start_[spring.id + 1];
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (const LoadedSpring& spring : springs) springs_[next[spring.id]++] = spring;
    for (std::size_t i = 0; i < granules; ++i) // a large granule may have hundreds
      std::sort(springs_.data() + start_[i], springs_.data() + start_[i + 1], by_partner);
  }

  const LoadedSpring* find(std::uint32_t id, std::uint32_t partner) const {
    const LoadedSpring *const first = springs_.data() + start_[id], *const last = springs_.data() + start_[id + 1];
    const LoadedSpring* const found = std::lower_bound(first, last, LoadedSpring{id, partner, {}}, by_partner);
    return found != last && found->partner == partner ? found : nullptr;
  }

private:
  static bool by_partner(const LoadedSpring& a, const LoadedSpring& b) { return a.partner < b.partner; }

  std::vector<LoadedSpring> springs_; ///< by id
  std::vector<std::uint32_t> start_;
};

void give(SpringMemory::Rows& rows, const PairList& pairs, const Granules& granules, const Register& all,
          std::uint32_t mark) {
  rows.reset(pairs.count());
  for (std::size_t k = 0; k < pairs.count(); ++k) {
    const RowPair pair = pairs.data()[k];
    if (pair.first() >= granules.count()) continue;
    const std::uint32_t first = granules.id[pair.first()], second = granules.id[pair.second()];
    const LoadedSpring* spring = first < second ? all.find(first, second) : all.find(second, first);
    if (spring == nullptr) continue;
    rows.row[k] = first < second ? spring->row : turned_round(spring->row);
    rows.touched[k] = mark;
  }
}

} // namespace

void SpringMemory::Rows::reset(std::size_t entries) {
  row.assign(entries, SpringRow{}); // a fresh contact, whatever its mark
  touched.assign(entries, 0);
}

std::vector<LoadedSpring> SpringMemory::loaded(const VerletList& list, const Granules& granules, std::int64_t step,
                                               const Team& team) const {
  const std::uint32_t mark = mark_of(step);
  std::vector<std::vector<LoadedSpring>> parts(segments_.size());
  team.each(segments_.size(), [&](std::size_t s) {
    const Segment& segment = list.segments()[s];
    const SegmentRows& rows = segments_[s];
    take(parts[s], rows.inner, segment.inner, granules, mark);
    take(parts[s], rows.boundary, segment.boundary, granules, mark);
    for (std::size_t w = 0; w < rows.walls.size(); ++w)
      for (std::size_t k = 0; k < segment.walls[w].count; ++k)
        if (rows.walls[w].touched[k] == mark)
          parts[s].push_back({granules.id[segment.walls[w].granules[k]],
                              granules.count() + static_cast<std::uint32_t>(w), rows.walls[w].row[k]});
    std::erase_if(parts[s], [](const LoadedSpring& spring) { return spring.row.root == 0.0; });
  });
  std::vector<LoadedSpring> springs;
  for (const auto& part : parts) springs.insert(springs.end(), part.begin(), part.end());
  return springs;
}

void SpringMemory::spread(const std::vector<LoadedSpring>& springs, const VerletList& list, const Granules& granules,
                          std::int64_t step, const Team& team) {
  const std::uint32_t mark = mark_of(step);
  const Register all(springs, granules.count());
  segments_.resize(list.segments().size());
  team.each(segments_.size(), [&](std::size_t s) {
    const Segment& segment = list.segments()[s];
    SegmentRows& rows = segments_[s];
    give(rows.inner, segment.inner, granules, all, mark);
    give(rows.boundary, segment.boundary, granules, all, mark);
    rows.walls.resize(segment.walls.size());
    for (std::size_t w = 0; w < segment.walls.size(); ++w) {
      const WallList& wall = segment.walls[w];
      rows.walls[w].reset(wall.granules.size());
      for (std::size_t k = 0; k < wall.count; ++k) {
        const LoadedSpring* spring =
            all.find(granules.id[wall.granules[k]], granules.count() + static_cast<std::uint32_t>(w));
        if (spring == nullptr) continue;
        rows.walls[w].row[k] = spring->row;
        rows.walls[w].touched[k] = mark;
      }
    }
    rows.slots.resize(kernels::contact_scratch);
  });
}

kernels::SpringArguments SpringMemory::arguments(Rows& rows, std::vector<std::uint32_t>& slots, std::size_t first,
                                                 std::int64_t step) {
  kernels::SpringArguments a;
  a.rows = rows.row.data() + first;
  a.touched = rows.touched.data() + first;
  a.slots = slots.data();
  a.now = mark_of(step);
  a.before = mark_of(step - 1);
  return a;
}

} // namespace grandamp
