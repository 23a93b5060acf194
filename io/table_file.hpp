// An excitation from a CSV file: a force or a motion by time.
#pragma once

#include "solver/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

struct TableFile {
  TableQuantity quantity = TableQuantity::force;
  std::vector<double> times;  ///< s, increasing
  std::vector<double> values; ///< N, m or m/s^2

  std::vector<std::string> faults; ///< "line 17: ...": what is wrong; the rest means nothing then
  bool unreadable = false;         ///< the file could not be opened or read
};

/// Reads a header row of two columns, time and one of force, displacement and acceleration, and a row per instant.
TableFile read_table_file(const std::filesystem::path& file);

/// The same for the file's content.
TableFile parse_table(const std::string& content);

} // namespace grandamp
