// The granules in their enclosure as one picture that stands still. Internal to io.
#pragma once

#include "solver/scene.hpp"

#include <string>
#include <vector>

namespace grandamp::report {

/// The enclosure's box: lower corner and lengths, m.
struct Extent {
  Vector3 low{0.0, 0.0, 0.0}, size{0.0, 0.0, 0.0};
};
Extent extent_of(const Enclosure& enclosure);
/// Pairs of points, m: the lines that an enclosure is drawn by.
std::vector<Vector3> edges_of(const Enclosure& enclosure);

/// Text like "#440154" along a scale from dark to light that stays in order for all eyes and in grey (viridis).
const std::vector<std::string>& colour_scale();
/// The colour at a share of the scale, 0 to 1.
std::string scale_colour(double share);

/// Seen from a corner, without perspective. `colours`, one per granule. Granules that others hide are left out.
std::string granules_picture(const std::string& title, const Enclosure& enclosure,
                             const std::vector<Vector3>& positions, const std::vector<double>& radii,
                             const std::vector<std::string>& colours);

} // namespace grandamp::report
