// Granules of unlike sizes: what is small enough for the grid of cells, and what is looked for one by one.
#pragma once

#include "solver/scene.hpp"

#include <cstddef>
#include <vector>

namespace grandamp {

struct RadiusCount {
  double radius = 0.0; ///< m
  std::size_t count = 0;
};

/// How many granules there are of each radius, radii rising.
std::vector<RadiusCount> radius_counts(const Scene& scene);

/// Mean over the granules, m; the radius itself where they are alike; 0 without granules.
double mean_radius(const std::vector<RadiusCount>& sizes);

/// The radius up to which granules are sorted into cells of their own size, larger ones being looked for one by one:
/// that of the largest where two levels would not save a search for neighbours at least a fifth of its tests.
/// @param sizes   of radius_counts(); empty: the result is 0
/// @param skin    of the list, m
double largest_in_cells(const std::vector<RadiusCount>& sizes, double skin);

} // namespace grandamp
