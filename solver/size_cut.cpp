#include "solver/size_cut.hpp"

#include "solver/measures.hpp"

#include <algorithm>
#include <cmath>

namespace grandamp {

namespace {

/// Radii that are tried as the largest of the small.
constexpr int radii_tried = 64;
/// In tests of a granule among eight in float, as measured: what each granule in cells costs besides, a test in double,
/// one by itself, a line of cells to be looked through for a large granule, and a pair found there, which is sorted.
constexpr double each_granule = 160.0, exact_test = 2.5, single_test = 10.0, line_of_cells = 130.0,
                 line_of_cells_of_large = 30.0, pair_found = 100.0;

constexpr double cube(double x) {
  return x * x * x;
}

/// Tests of one search with granules up to `cut` in cells: those of a bed, since where granules are apart there are few
/// to test either way.
double tests(const std::vector<RadiusCount>& sizes, double cut, double skin) {
  constexpr double solid_fraction = 0.6;
  double solid = 0.0, all = 0.0, large = 0.0;
  for (const RadiusCount& size : sizes) {
    const auto count = static_cast<double>(size.count);
    solid += count * sphere_volume(size.radius);
    all += count;
    if (size.radius > cut) large += count;
  }
  const double density = all * solid_fraction / solid, cell = 2.0 * cut + skin;
  // Large granules among themselves: those of 27 cells, in nine lines.
  const double among_large = 9.0 * line_of_cells_of_large +
                             single_test * 27.0 * density * large / all * cube(2.0 * sizes.back().radius + skin);
  double sum = large * among_large;
  for (const RadiusCount& size : sizes) {
    const auto count = static_cast<double>(size.count);
    if (size.radius <= cut) {
      sum += count * (each_granule + 13.5 * density * cube(cell));
      continue;
    }
    const double reach = size.radius + cut + skin, side = 2.0 * reach + cell;
    const double within = sphere_volume(reach) - sphere_volume(size.radius);
    sum += count * (exact_test * density * cube(side) + line_of_cells * side * side / (cell * cell) +
                    pair_found * density * within);
  }
  return sum;
}

} // namespace

std::vector<RadiusCount> radius_counts(const Scene& scene) {
  std::vector<RadiusCount> given, sizes;
  const auto add = [](std::vector<RadiusCount>& to, double radius, std::size_t count) {
    if (to.empty() || to.back().radius != radius) to.push_back({radius, 0});
    to.back().count += count;
  };
  for (const Population& population : scene.populations) {
    if (population.radii.empty() && population.count > 0) add(given, population.radius, population.count);
    for (const double radius : population.radii) add(given, radius, 1);
  }
  std::sort(given.begin(), given.end(), [](const RadiusCount& a, const RadiusCount& b) { return a.radius < b.radius; });
  for (const RadiusCount& size : given) add(sizes, size.radius, size.count);
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

double largest_in_cells(const std::vector<RadiusCount>& sizes, double skin) {
  if (sizes.empty()) return 0.0;
  const double smallest = sizes.front().radius, all = sizes.back().radius;
  double best = all, least = 0.8 * tests(sizes, all, skin);
  // Steps of one ratio, so that no gap between sizes is missed, each down to the largest granule below it.
  const double ratio = std::pow(all / smallest, 1.0 / radii_tried);
  double cut = smallest;
  for (int k = 0; k < radii_tried; ++k, cut *= ratio) {
    const auto beyond = std::upper_bound(sizes.begin(), sizes.end(), cut,
                                         [](double radius, const RadiusCount& size) { return radius < size.radius; });
    if (beyond == sizes.begin()) continue;
    const double radius = std::prev(beyond)->radius;
    const double needed = tests(sizes, radius, skin);
    if (needed < least) {
      least = needed;
      best = radius;
    }
  }
  return best;
}

} // namespace grandamp
