// A whole results.h5, written from what a run recorded.
#pragma once

#include "io/record_log.hpp"
#include "io/results.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace grandamp {

struct RecordedRun {
  const std::string* scene_text = nullptr;
  const RecordLog* rows = nullptr;          ///< of the histories: doubles, in the order of history_columns; flushed
  const RecordLog* snapshots = nullptr;     ///< null: none; flushed
  const Snapshot* final_granules = nullptr; ///< null: the run is not at its end
  std::function<bool()> abandon;            ///< asked after every block and every snapshot; empty: never
};

/// Thrown once `abandon` said so.
struct FoldAbandoned {};

/// Replaces the file as a whole: whatever goes wrong, what was there before stays. Throws FileError, FoldAbandoned.
void write_results_file(const std::filesystem::path& path, const RecordedRun& run);

} // namespace grandamp
