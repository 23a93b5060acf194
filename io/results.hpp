// results.h5: the histories of a run, its granules at the end, and the scene. The layout is told in io/FORMAT.md.
#pragma once

#include "solver/simulation.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace grandamp {

/// Writes results.h5 as a run goes. Throws FileError with the path and the reason. On the disk there is a whole file at
/// any time, the last one flushed; all of it is held in memory too, 8 bytes per number.
class ResultsWriter {
public:
  /// Replaces the file if there is one. `ledger`: whether samples carry the energy ledger, and so its columns.
  ResultsWriter(const std::filesystem::path& path, const std::string& scene_text, bool ledger);
  ~ResultsWriter();
  ResultsWriter(ResultsWriter&&) noexcept;
  ResultsWriter& operator=(ResultsWriter&&) noexcept;

  /// A row of the histories. Rows are kept back and written in blocks.
  void append(const Sample& sample);
  /// What was appended so far reaches the file, which can be read from here on even if the run is cut.
  void flush();
  /// The granules by id; `time` in seconds. At most once.
  void write_final(const GranuleTable& granules, double time);
  /// Flushes and closes; without it what came after the last flush is lost.
  void close();

private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The histories of a run, column by column, in the order of the file.
struct History {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns; ///< all of one length
};

/// The granules of a run at one time.
struct FinalGranules {
  double time = 0.0; ///< s
  GranuleTable table;
};

/// Reads results.h5. Throws FileError.
History read_history(const std::filesystem::path& path);
FinalGranules read_final_granules(const std::filesystem::path& path);
std::string read_stored_scene(const std::filesystem::path& path);

/// Comma-separated with a header row, 17 significant digits. Throws FileError.
void export_history(const History& history, const std::filesystem::path& csv);
void export_granules(const GranuleTable& granules, const std::filesystem::path& csv);

} // namespace grandamp
