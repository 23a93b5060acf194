#include "solver/size_cut.hpp"

#include "solver/measures.hpp"

#include <algorithm>
#include <map>
#include <numbers>

namespace grandamp {

namespace {

/// Radii that are tried at most.
constexpr std::size_t most_tried = 64;
/// In tests of a granule among eight in float, as measured: what each granule in cells costs besides, a test in double,
/// one by itself, a line of cells to be looked through for a large granule, and a pair found there, which is sorted.
constexpr double each_granule = 160.0, exact_test = 2.5, single_test = 15.0, line_of_cells = 130.0, pair_found = 100.0;

constexpr double cube(double x) {
  return x * x * x;
}

/// Tests of one search with granules up to `cut` in cells: those of a bed, since where granules are apart there are few
/// to test either way.
double tests(const std::vector<RadiusCount>& sizes, double cut, double skin, double height) {
  constexpr double solid_fraction = 0.6;
  double solid = 0.0, all = 0.0;
  for (const RadiusCount& size : sizes) {
    const auto count = static_cast<double>(size.count);
    solid += count * 4.0 / 3.0 * std::numbers::pi * size.radius * size.radius * size.radius;
    all += count;
  }
  const double density = all * solid_fraction / solid, cell = 2.0 * cut + skin;
  double sum = 0.0, large = 0.0;
  for (const RadiusCount& size : sizes) {
    const auto count = static_cast<double>(size.count);
    if (size.radius <= cut) {
      sum += count * (each_granule + 13.5 * density * cube(cell));
      continue;
    }
    const double reach = size.radius + cut + skin, side = 2.0 * reach + cell;
    const double ball = 4.0 / 3.0 * std::numbers::pi, within = ball * (cube(reach) - cube(size.radius));
    sum += count * (exact_test * density * cube(side) + line_of_cells * side * side / (cell * cell) +
                    pair_found * density * within);
    large += count;
  }
  const double reach = std::min(1.0, 2.0 * (sizes.back().radius + skin) / height);
  return sum + 0.5 * single_test * large * large * reach;
}

} // namespace

std::vector<RadiusCount> radius_counts(const Scene& scene) {
  std::map<double, std::size_t> counts;
  for (const Population& population : scene.populations) {
    if (population.radii.empty() && population.count > 0) counts[population.radius] += population.count;
    for (const double radius : population.radii) ++counts[radius];
  }
  std::vector<RadiusCount> sizes;
  sizes.reserve(counts.size());
  for (const auto& [radius, count] : counts) sizes.push_back({radius, count});
  return sizes;
}

double mean_radius(const std::vector<RadiusCount>& sizes) {
  if (sizes.empty()) return 0.0;
  double sum = 0.0, all = 0.0;
  for (const RadiusCount& size : sizes) {
    sum += static_cast<double>(size.count) * size.radius;
    all += static_cast<double>(size.count);
  }
  return sizes.size() == 1 ? sizes.front().radius : sum / all;
}

double largest_in_cells(const std::vector<RadiusCount>& sizes, double skin, double height) {
  if (sizes.empty()) return 0.0;
  const double all = sizes.back().radius;
  double best = all, least = 0.8 * tests(sizes, all, skin, height);
  const std::size_t stride = sizes.size() / most_tried + 1;
  for (std::size_t k = 0; k + 1 < sizes.size(); k += stride) {
    const double needed = tests(sizes, sizes[k].radius, skin, height);
    if (needed < least) {
      least = needed;
      best = sizes[k].radius;
    }
  }
  return best;
}

} // namespace grandamp
