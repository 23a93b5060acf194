// What the runs of a sweep come to: means and errors of every point, as CSV, JSON and HDF5. Internal to io.
#pragma once

#include "io/sweep_grid.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace grandamp {

/// Of one point, over its seeds.
struct PointStatistics {
  std::size_t done = 0, failed = 0;
  std::map<std::string, MeanAndError> numbers; ///< by the dotted name of the summary
  const MeanAndError* find(const std::string& name) const;
  /// Whether every run that is done was steady; false without a structure.
  bool steady() const;
  /// "done", "failed" (all of them), "partly failed", "incomplete".
  std::string status(std::size_t seeds) const;
};

struct SweepTable {
  std::string title, scene_text, isa;
  std::vector<VariedKey> keys;
  std::size_t seeds = 1;
  bool keep_total_mass = false;
  std::vector<CasePoint> points;
  std::vector<CaseRun> runs;            ///< seeds of a point side by side
  std::vector<PointStatistics> results; ///< of every point
  std::vector<std::string> names;       ///< numbers of interest that any run has
  std::vector<std::string> pictures;    ///< file names
  std::filesystem::path folder;

  const CaseRun& run(std::size_t point, std::size_t seed) const { return runs[point * seeds + seed]; }
  std::size_t count(CaseStatus status) const;
  /// From the runs: results and names.
  void sum_up();

  std::string csv() const;
  std::string runs_csv() const;
  std::string json() const;
  void write_hdf5() const; ///< sweep.h5. Throws FileError.
};

/// A field of a CSV: quoted where it has to be.
std::string csv_text(const std::string& text);
/// Empty for NaN.
std::string csv_number(double value);

} // namespace grandamp
