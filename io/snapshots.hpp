// Snapshots of the granules on their way to results.h5.
#pragma once

#include "io/hdf5.hpp"
#include "io/record_log.hpp"
#include "solver/simulation.hpp"

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

namespace grandamp {

/// The granules of a run at one time.
struct Snapshot {
  double time = 0.0; ///< s
  GranuleTable table;
};

/// As a record of a log of this kind.
inline constexpr std::string_view snapshots_kind = "snapshots";
std::vector<std::byte> pack(const GranuleTable& granules, double time);
Snapshot unpack(const std::vector<std::byte>& record);
/// One of a log's; throws FileError.
Snapshot read_snapshot(const RecordLog& log, std::int64_t index);

/// /snapshots, from the log: flushed, with at least one. Takes the memory of two snapshots. `pulse` is called after
/// each. Throws FileError.
void write_snapshots(hdf5::File& file, const RecordLog& log, const std::function<void()>& pulse);

/// Of a results file; none if it has none. Throws FileError.
std::vector<double> read_snapshot_times(const hdf5::File& file);
Snapshot read_snapshot(const hdf5::File& file, std::size_t index);

/// /final. Throws FileError.
void write_final_granules(hdf5::File& file, const Snapshot& granules);
Snapshot read_final_granules(const hdf5::File& file);

} // namespace grandamp
