// Granules from a CSV file, as `grandamp export` writes them or as another program does.
#pragma once

#include "solver/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

/// The granules of a file; in order of `id` if it has that column, otherwise row by row. Lists are empty where the file
/// has none of their columns; a component that it lacks (vx without vy) is zero.
struct GranuleFile {
  std::vector<Vector3> positions;  ///< m
  std::vector<Vector3> velocities; ///< m/s
  std::vector<Vector3> spins;      ///< rad/s
  std::vector<double> radii;       ///< m
  std::vector<double> densities;   ///< kg/m^3

  std::vector<std::string> faults; ///< "line 17: ...": what is wrong; the lists mean nothing then
  bool unreadable = false;         ///< the file could not be opened or read
};

/// Reads a header row naming x, y, z and any of id, radius, density, vx, vy, vz, wx, wy, wz, in any order, and a row
/// per granule.
GranuleFile read_granule_file(const std::filesystem::path& file);

/// The same for the file's content.
GranuleFile parse_granules(const std::string& content);

} // namespace grandamp
