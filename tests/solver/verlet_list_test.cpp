// The list that the grid finds, against a look at every pair.
#include "solver/verlet_list.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <random>

using namespace grandamp;

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>; ///< identities, the smaller one first
constexpr double radius = 1.0e-3, skin = 0.3e-3;

double radius_of(std::uint32_t id, bool alike) {
  return alike ? radius : radius * (0.4 + 0.6 * (id % 7) / 6.0);
}

/// Places in the box's far corner, where float is worst, in a cluster whose neighbours are often just within reach of
/// each other, or just beyond.
Granules make_granules(std::uint32_t count, const Vector3& size, bool alike, double cluster) {
  Granules granules(count, {});
  std::mt19937_64 engine(11);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const double r = radius_of(i, alike);
    Vector3 at;
    if (i % 2 == 0) {
      for (std::size_t k = 0; k < 3; ++k) at[k] = size[k] - random(0.0, std::min(size[k], cluster));
    } else {
      const kernels::PositionRow& other = granules.position[i - 1];
      const double beyond[] = {-1e-9, 1e-9, -1e-12, 1e-12};
      const double reach = (r + other.radius + skin) * (1.0 + beyond[i / 2 % 4]);
      Vector3 way{random(-1.0, 1.0), random(-1.0, 1.0), random(-1.0, 1.0)};
      const double length = std::hypot(way[0], way[1], way[2]);
      const double from[] = {other.x, other.y, other.z};
      for (std::size_t k = 0; k < 3; ++k) at[k] = from[k] + way[k] * reach / length;
    }
    granules.position[i] = {at[0], at[1], at[2], r};
    granules.id[i] = i;
    granules.population[i] = 0;
  }
  granules.set_ghosts();
  return granules;
}

/// Square of the distance, as exactly as the list has to know it.
double square(const kernels::PositionRow& a, const kernels::PositionRow& b) {
  const double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
  return std::fma(z, z, std::fma(y, y, x * x));
}

} // namespace

TEST_CASE("Verlet list: the grid finds every pair within reach, no other, and the class of its gap") {
  const Team team(1);
  using kernels::InstructionSet;
  for (const InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512})
    for (const bool alike : {true, false})
      for (const Vector3& size : {Vector3{0.03, 0.02, 0.04}, Vector3{0.003, 0.2, 0.02}, Vector3{50.0, 0.02, 200.0},
                                  Vector3{0.005, 0.008, 0.005}, Vector3{0.02, 0.02, 0.06}}) {
        // The last but one: hundreds in a cell; the last, once: two segments.
        const bool cut = size[2] == 0.06;
        if (!kernels::available(set) || (cut && (alike || set != InstructionSet::avx2))) continue;
        CAPTURE(std::string(kernels::name(set)));
        CAPTURE(alike);
        CAPTURE(size[0]);
        const std::uint32_t count = cut ? 20000 : 1500;
        Granules granules = make_granules(count, size, alike, cut ? 0.06 : 0.02);
        VerletList::Search search = VerletList::Search::with(set, alike, radius);
        search.skin = skin;
        search.cell_length = 2.0 * radius + skin;
        VerletList list;
        list.build(granules, size, {}, search, team);

        std::map<Pair, std::size_t> found; // and its class
        std::size_t listed = 0;
        std::size_t across = 0;
        for (const Segment& segment : list.segments()) {
          across += segment.boundary.count();
          for (const Block& block : segment.blocks) // full at the first cell that makes it so
            if (cut) CHECK(block.last - block.first < block_granules(count) + 100);
        }
        CHECK((across > 0) == cut);
        for (const Segment& segment : list.segments())
          for (const Block& block : segment.blocks)
            for (const auto& [pairs, range] :
                 {std::pair{&segment.inner, block.inner}, std::pair{&segment.boundary, block.boundary}}) {
              std::size_t c = 0;
              for (std::size_t k = range.first; k < range.end.back(); ++k) {
                while (k >= range.end[c]) ++c;
                const kernels::RowPair pair = pairs->data()[k];
                if (pair.first() >= count) continue;
                ++listed;
                found[std::minmax(granules.id[pair.first()], granules.id[pair.second()])] = c;
              }
            }
        CHECK(listed == found.size());
        CHECK(listed == list.candidates());

        std::size_t wanted = 0, wrong = 0, wrong_class = 0, looked_up = 0;
        const bool fused = set != InstructionSet::generic;
        for (std::uint32_t i = 0; i < count; ++i)
          for (std::uint32_t j = i + 1; j < count; ++j) {
            const kernels::PositionRow &a = granules.position[i], &b = granules.position[j];
            if (cut && std::max(std::abs(a.x - b.x), std::abs(a.z - b.z)) > 2.0 * radius + skin) continue;
            const auto reach = [&](double share) {
              return share * skin + (alike ? 2.0 * radius : a.radius + b.radius);
            };
            const auto within = [&](double share) { return square(a, b) < reach(share) * reach(share); };
            // Without a fused multiply-add a pair on the very edge may fall either way.
            if (!fused && std::abs(square(a, b) / (reach(1.0) * reach(1.0)) - 1.0) < 1e-14) continue;
            const auto it = found.find(std::minmax(granules.id[i], granules.id[j]));
            if (it != found.end()) ++looked_up;
            if (within(1.0)) ++wanted;
            if (within(1.0) != (it != found.end()))
              ++wrong;
            else if (it != found.end()) {
              const auto c = static_cast<double>(it->second);
              if ((c > 0.0 && within(0.25 * c)) || !within(0.25 * (c + 1.0))) ++wrong_class;
            }
          }
        CHECK(wanted > 700);
        CHECK(wrong == 0);
        if (cut) CHECK(looked_up == found.size()); // none is listed that was not looked at
        CHECK(wrong_class <= (fused ? 0U : 2U));
      }
}

TEST_CASE("Verlet list: a crowded cell takes room for the pairs found, not for all that are tested") {
  const std::uint32_t count = 3000;
  const double small = 0.05e-3, narrow_skin = 0.02e-3;
  const Vector3 size{2.5e-3, 2.5e-3, 2.5e-3};
  Granules granules(count, {});
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> place(0.0, 2.5e-3);
  for (std::uint32_t i = 0; i < count; ++i) {
    granules.position[i] = {place(engine), place(engine), place(engine), i == 0 ? radius : small};
    granules.id[i] = i;
    granules.population[i] = 0;
  }
  granules.set_ghosts();
  VerletList::Search search = VerletList::Search::with(kernels::InstructionSet::generic, false, radius);
  search.skin = narrow_skin;
  search.cell_length = 2.0 * radius + narrow_skin;
  VerletList list;
  list.build(granules, size, {}, search, Team(1));
  REQUIRE(list.grid().shape().total() == 1);
  std::size_t wanted = 0;
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t j = i + 1; j < count; ++j) {
      const kernels::PositionRow &a = granules.position[i], &b = granules.position[j];
      const double reach = a.radius + b.radius + narrow_skin;
      if (square(a, b) < reach * reach) ++wanted;
    }
  CHECK(wanted > 2000);
  CHECK(list.candidates() == wanted);
  CHECK(list.segments().front().inner.room() < 150'000); // of 4.5 million tested
}
