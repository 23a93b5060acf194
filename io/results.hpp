// results.h5: the histories of a run, its snapshots, its granules at the end, and the scene. The layout is told in
// io/FORMAT.md.
#pragma once

#include "io/snapshots.hpp"
#include "solver/simulation.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// How much of a run was recorded: what a checkpoint remembers, so that a run that goes on from it knows where to cut.
struct ResultsPosition {
  std::int64_t rows = 0;      ///< of the histories
  std::int64_t snapshots = 0; ///< taken
};

/// Records a run. What is appended goes to logs beside results.h5 (history.part, snapshots.part); now and then, and at
/// the end, they are folded: a new results.h5 is written whole beside the old one, synced and put in its place (and
/// snapshots.xdmf, which tells ParaView where in it the snapshots are). So results.h5 can be read at any time, and a
/// kill costs nothing that was synced. Memory stays flat; on the disk a running run takes twice its results. All
/// members throw FileError with the path and the reason; results.h5 is then as after the last fold.
class ResultsWriter {
public:
  /// `results`: the path of results.h5, which is replaced if it is there, as are the logs of an earlier run beside it.
  /// `ledger`: whether samples carry the energy ledger, and so its columns.
  ResultsWriter(const std::filesystem::path& results, const std::string& scene_text, bool ledger);
  /// Goes on with a run that was stopped, killed or finished: what lies after `from` is cut off, in results.h5 too.
  /// `latest`, if given, is the last row before that. Throws FileError also if less than that is there, or the last row
  /// is another: the results are then of another run than the checkpoint.
  static ResultsWriter go_on(const std::filesystem::path& results, const std::string& scene_text, bool ledger,
                             const ResultsPosition& from, const Sample* latest = nullptr);
  /// Leaves everything as a kill would: the last fold and the logs.
  ~ResultsWriter();
  ResultsWriter(ResultsWriter&&) noexcept;
  ResultsWriter& operator=(ResultsWriter&&) noexcept;

  /// A row of the histories.
  void append(const Sample& sample);
  /// The granules by id, at `time`, s; always as many.
  void append_snapshot(const GranuleTable& granules, double time);
  /// What was recorded so far.
  ResultsPosition position() const;
  /// What was recorded so far is on the disk and outlives a power cut: to be called before a checkpoint that remembers
  /// position() is put in place.
  void sync();
  /// results.h5 now holds what was recorded so far.
  void fold();
  /// The same, if there is something new and folds have cost less than 1 % of the time so far; at most every 5 s.
  /// Every fold writes everything anew, so they grow rarer as results grow: a run's results.h5 lags behind the run by
  /// about a hundred times what it takes to write. `abandon` is asked on the way: once true the fold is given up.
  void fold_if_due(const std::function<bool()>& abandon = {});
  /// The granules at the end, by id; `time` in seconds. Written by close().
  void write_final(const GranuleTable& granules, double time);
  /// Folds, and removes the logs.
  void close();

private:
  struct State;
  explicit ResultsWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The histories of a run, column by column, in the order of the file.
struct History {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns; ///< all of one length
};

/// Reads results.h5, and of a run that goes on or was killed also what the logs beside it hold beyond it.
/// `only`: these columns; empty: all. Throws FileError.
History read_history(const std::filesystem::path& path, const std::vector<std::string>& only = {});
Snapshot read_final_granules(const std::filesystem::path& path);
/// The snapshot nearest to `time`, s; the granules at the end count as one, where the run came to its end. Nothing if
/// the run took no snapshots.
std::optional<Snapshot> read_snapshot_near(const std::filesystem::path& path, double time);
/// The snapshots of a run one by one, those that only the log beside the results holds, too.
class SnapshotReader {
public:
  explicit SnapshotReader(const std::filesystem::path& path);
  ~SnapshotReader();
  SnapshotReader(const SnapshotReader&) = delete;
  SnapshotReader& operator=(const SnapshotReader&) = delete;
  const std::vector<double>& times() const; ///< s
  Snapshot read(std::size_t index) const;

private:
  friend std::optional<Snapshot> read_snapshot_near(const std::filesystem::path& path, double time);
  struct State;
  std::unique_ptr<State> state_;
};
std::string read_stored_scene(const std::filesystem::path& path);

/// Comma-separated with a header row, 17 significant digits. Throws FileError.
void export_history(const History& history, const std::filesystem::path& csv);
void export_granules(const GranuleTable& granules, const std::filesystem::path& csv);

} // namespace grandamp
