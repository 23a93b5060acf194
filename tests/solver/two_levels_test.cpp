// Granules of unlike sizes, small ones in cells of their own and large ones looked for one by one, against a look at
// every pair.
#include "solver/simulation.hpp"
#include "solver/size_cut.hpp"
#include "solver/verlet_list.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

using namespace grandamp;

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>; ///< rows, the smaller one first
constexpr double small = 0.5e-3, large = 5.0e-3, skin = 0.2e-3;

/// One in `every` is large: from just larger than the small ones to the largest.
Granules make_granules(std::uint32_t count, const Vector3& size, std::uint32_t every) {
  Granules granules(count, {});
  std::mt19937_64 engine(5);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const double r = i % every != 0 ? small * random(0.5, 1.0) : i % (2 * every) != 0 ? large : random(small, large);
    granules.position[i] = {random(0.0, size[0]), random(0.0, size[1]), random(0.0, size[2]), r};
    granules.id[i] = i;
    granules.population[i] = 0;
  }
  granules.set_ghosts();
  return granules;
}

VerletList::Search two_levels(kernels::InstructionSet set) {
  VerletList::Search search = VerletList::Search::with(set, false, large);
  search.small_radius = small;
  search.skin = skin;
  search.cell_length = 2.0 * small + skin;
  return search;
}

double square(const kernels::PositionRow& a, const kernels::PositionRow& b) {
  const double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
  return std::fma(z, z, std::fma(y, y, x * x));
}

/// The pairs listed, with the class of their gap; all that a sweep relies on is checked on the way.
std::map<Pair, std::size_t> listed(const VerletList& list, std::uint32_t ghost) {
  std::map<Pair, std::size_t> pairs;
  std::size_t count = 0, wrong = 0;
  std::vector<std::uint32_t> last_reached(list.segments().size(), 0), first_of(list.segments().size(), ghost);
  for (std::size_t s = 0; s < list.segments().size(); ++s) {
    const Segment& segment = list.segments()[s];
    for (const Block& block : segment.blocks)
      for (const bool inner : {true, false}) {
        const PairRange& range = inner ? block.inner : block.boundary;
        std::size_t c = 0;
        for (std::size_t k = range.first; k < range.end.back(); ++k) {
          while (k >= range.end[c]) ++c;
          const kernels::RowPair pair = (inner ? segment.inner : segment.boundary).data()[k];
          const std::uint32_t first = pair.first(), second = pair.second();
          if (first >= ghost) continue; // padding
          ++count;
          pairs[{first, second}] = c;
          if (first < block.first || first >= block.last || second <= first) ++wrong;
          if (inner && (second >= segment.last || second >= block.front)) ++wrong;
          if (inner) continue;
          if (s + 1 == list.segments().size() || second < segment.last || second >= list.segments()[s + 1].last)
            ++wrong;
          // Two threads add to the rows of two segments' boundaries at the same time.
          last_reached[s] = std::max(last_reached[s], second);
          first_of[s] = std::min(first_of[s], first);
        }
      }
  }
  CHECK(wrong == 0);
  for (std::size_t s = 1; s < list.segments().size(); ++s) CHECK(last_reached[s - 1] < first_of[s]);
  CHECK(count == pairs.size());
  CHECK(count == list.candidates());
  return pairs;
}

void check_against_all_pairs(const VerletList& list, const Granules& granules, bool fused, std::size_t least) {
  const std::map<Pair, std::size_t> found = listed(list, granules.count());
  std::size_t wanted = 0, of_large = 0, of_two = 0, wrong = 0, looked_up = 0;
  for (std::uint32_t i = 0; i < granules.count(); ++i)
    for (std::uint32_t j = i + 1; j < granules.count(); ++j) {
      const kernels::PositionRow &a = granules.position[i], &b = granules.position[j];
      const double distance = square(a, b), touch = a.radius + b.radius;
      if (distance > 1.001 * (touch + skin) * (touch + skin)) continue;
      const auto within = [&](double share) { return distance < (touch + share * skin) * (touch + share * skin); };
      if (!fused && std::abs(distance / ((touch + skin) * (touch + skin)) - 1.0) < 1e-14) continue;
      const auto it = found.find({i, j});
      if (it != found.end()) ++looked_up;
      if (within(1.0) != (it != found.end())) {
        ++wrong;
        continue;
      }
      if (it == found.end()) continue;
      ++wanted;
      const int of = static_cast<int>(a.radius > small) + static_cast<int>(b.radius > small);
      if (of > 0) ++of_large;
      if (of > 1) ++of_two;
      const auto c = static_cast<double>(it->second);
      if (fused && ((c > 0.0 && within(0.25 * c)) || !within(0.25 * (c + 1.0)))) ++wrong;
    }
  CHECK(wrong == 0);
  CHECK(looked_up == found.size());
  CHECK(wanted > of_large + least);
  CHECK(of_large > of_two + least);
  CHECK(of_two > least / 10);
}

} // namespace

TEST_CASE("two levels: every pair within reach, none twice, no other, and the class of its gap") {
  using kernels::InstructionSet;
  for (const InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!kernels::available(set)) continue;
    CAPTURE(std::string(kernels::name(set)));
    // The second is flatter than a large granule is wide; the third has one cell only.
    for (const Vector3& size :
         {Vector3{0.03, 0.025, 0.04}, Vector3{0.06, 0.008, 0.06}, Vector3{1.1e-3, 1.1e-3, 1.1e-3}}) {
      CAPTURE(size[0]);
      const bool one_cell = size[0] < 2e-3;
      Granules granules = make_granules(one_cell ? 60 : 4000, size, one_cell ? 5 : 40);
      VerletList list;
      list.build(granules, size, {}, two_levels(set), Team(1));
      CHECK(list.segments().size() == 1);
      check_against_all_pairs(list, granules, set != InstructionSet::generic, one_cell ? 50 : 100);
    }
  }
}

TEST_CASE("two levels: segments thick enough for the largest, and the same list on any number of threads") {
  const Vector3 size{0.02, 0.02, 0.2};
  const kernels::InstructionSet set = kernels::best_available();
  std::map<Pair, std::size_t> alone;
  for (const int threads : {1, 2, 3}) {
    CAPTURE(threads);
    Granules granules = make_granules(20500, size, 200);
    VerletList list;
    list.build(granules, size, make_walls(Enclosure{.size = size}), two_levels(set), Team(threads));
    CHECK(list.segments().size() > 2);
    std::size_t across = 0;
    for (const Segment& segment : list.segments()) across += segment.boundary.count();
    CHECK(across > 0);
    if (threads > 1) {
      CHECK(listed(list, granules.count()) == alone);
      continue;
    }
    check_against_all_pairs(list, granules, set != kernels::InstructionSet::generic, 100);
    alone = listed(list, granules.count());
  }
}

TEST_CASE("two levels: walls know the granules near them, however many cells away the centre is") {
  for (const Vector3& size : {Vector3{0.03, 0.02, 0.04}, Vector3{0.04, 0.03, 0.02}, Vector3{0.02, 0.04, 0.03}}) {
    Granules granules = make_granules(3000, size, 20);
    const std::vector<Wall> walls = make_walls(Enclosure{.size = size});
    VerletList list;
    list.build(granules, size, walls, two_levels(kernels::best_available()), Team(1));
    for (std::size_t w = 0; w < walls.size(); ++w) {
      CAPTURE(w);
      std::multiset<std::uint32_t> near, wanted;
      for (const Segment& segment : list.segments())
        near.insert(segment.walls[w].granules.begin(),
                    segment.walls[w].granules.begin() + static_cast<std::ptrdiff_t>(segment.walls[w].count));
      std::size_t far = 0;
      for (std::uint32_t i = 0; i < granules.count(); ++i) {
        const double inside = distance_inside(walls[w], granules.position[i]);
        if (inside >= granules.position[i].radius + 0.5 * skin) continue;
        wanted.insert(i);
        if (inside > 2.0 * (2.0 * small + skin)) ++far;
      }
      CHECK(far > 2);
      CHECK(near == wanted);
    }
  }
}

TEST_CASE("two levels: a cylinder's bed under every policy that misses nothing, audited at every step") {
  for (const ListPolicy policy : {ListPolicy::guarded, ListPolicy::displacement, ListPolicy::none}) {
    CAPTURE(static_cast<int>(policy));
    Scene scene;
    scene.enclosure = Enclosure{.shape = EnclosureShape::cylinder, .diameter = 0.03, .height = 0.04, .axis = 2};
    scene.packing = PackingKind::random;
    for (const auto& [radius, count] : {std::pair{small, 1500}, std::pair{large, 3}}) {
      Population population;
      population.name = "of " + std::to_string(radius);
      population.radius = radius;
      population.count = static_cast<std::size_t>(count);
      population.mass = 2500.0 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
      population.speed = 5.0;
      scene.populations.push_back(population);
    }
    scene.contact.granule.stiffness = 1.0e7;
    scene.contact.granule.reference_radius = 3.0e-3;
    scene.contact.granule.restitution = 0.9;
    scene.contact.granule.friction = 0.3;
    scene.time.duration = 2.0e-3;
    scene.verlet.policy = policy;
    scene.verlet.audit = 1;
    Simulation simulation(scene, RunOptions{});
    CHECK(simulation.plan().small_radius == small);
    while (!simulation.finished()) simulation.step();
    CHECK(simulation.verlet().builds > 3);
    CHECK(simulation.verlet().audited > 300);
    CHECK(simulation.verlet().missed == 0);
    CHECK(simulation.guards().escaped == 0);
    CHECK(simulation.sample().contacts > 0);
  }
}

TEST_CASE("two levels: only where they save much") {
  const auto cut = [](const std::vector<RadiusCount>& sizes) { return largest_in_cells(sizes, skin); };
  CHECK(cut({}) == 0.0);
  CHECK(cut({{small, 1000}}) == small);
  CHECK(cut({{small, 100000}, {small * (1.0 + 1e-12), 1}}) == small * (1.0 + 1e-12));
  CHECK(cut({{small, 50000}, {1.3 * small, 50000}}) == 1.3 * small);
  CHECK(cut({{small, 100000}, {20.0 * small, 1}}) == small);
  CHECK(cut({{small, 100000}, {10.0 * small, 100}}) == small);
  CHECK(cut({{small, 10}, {10.0 * small, 100000}}) == 10.0 * small); // few small ones: nothing to save
  // However finely sizes are told apart, a gap between them is where they are cut.
  std::vector<RadiusCount> spread;
  for (int k = 0; k < 10000; ++k) spread.push_back({small * (0.98 + 4e-6 * k), 1});
  for (int k = 0; k < 10; ++k) spread.push_back({10.0 * small * (1.0 + 0.01 * k), 1});
  CHECK(cut(spread) == spread[9999].radius);
  CHECK(mean_radius({{small, 7}}) == small);
  CHECK(mean_radius({{1.0, 3}, {5.0, 1}}) == 2.0);
  CHECK(mean_radius({}) == 0.0);
}
