#include "io/results.hpp"

#include "io/history_columns.hpp"
#include "io/results_file.hpp"
#include "io/xdmf.hpp"
#include "solver/errors.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>
#include <system_error>

namespace grandamp {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double least_between_folds = 5.0; // s
constexpr double folds_apart = 110.0;       // times what a fold costs

std::size_t columns_with(bool ledger) {
  return static_cast<std::size_t>(std::count_if(history_columns.begin(), history_columns.end(),
                                                [&](const auto& column) { return ledger || !column.of_ledger; }));
}

fs::path beside(const fs::path& results, const char* name) {
  return results.parent_path() / name;
}

fs::path rows_path(const fs::path& results) {
  return beside(results, "history.part");
}

fs::path snapshots_path(const fs::path& results) {
  return beside(results, "snapshots.part");
}

fs::path xdmf_path(const fs::path& results) {
  return beside(results, "snapshots.xdmf");
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw FileError(path.string() + ": cannot remove the file: " + error.message());
}

/// The log of a run that was closed, from its results file.
RecordLog unfold_rows(const fs::path& results, std::size_t columns, std::int64_t rows) {
  const History history = read_history(results);
  const std::size_t there = history.columns.empty() ? 0 : history.columns.front().size();
  if (history.columns.size() != columns || static_cast<std::int64_t>(there) < rows) {
    throw FileError(results.string() + ": holds " + std::to_string(there) + " rows of " +
                    std::to_string(history.columns.size()) + " histories; to go on takes " + std::to_string(rows) +
                    " of " + std::to_string(columns));
  }
  // Under another name until it is whole: a log that is cut short would hide what results.h5 has.
  const fs::path fresh = beside(results, "history.part.new");
  RecordLog log = RecordLog::create(fresh, history_kind, columns * sizeof(double));
  std::vector<double> row(columns);
  for (std::size_t k = 0; k < static_cast<std::size_t>(rows); ++k) {
    for (std::size_t c = 0; c < columns; ++c) row[c] = history.columns[c][k];
    log.append(row.data());
  }
  log.sync();
  log.rename(rows_path(results));
  return log;
}

RecordLog open_rows(const fs::path& results, std::size_t columns, std::int64_t rows) {
  const fs::path path = rows_path(results);
  if (!is_there(path)) return unfold_rows(results, columns, rows);
  RecordLog log = RecordLog::open(path, history_kind, columns * sizeof(double));
  if (log.count() < rows) {
    throw FileError(path.string() + ": holds " + std::to_string(log.count()) + " whole rows; to go on takes " +
                    std::to_string(rows));
  }
  return log;
}

std::vector<double> row_of(const Sample& sample, std::size_t columns) {
  std::vector<double> row(columns);
  for (std::size_t c = 0; c < columns; ++c) row[c] = history_columns[c].value(sample);
  return row;
}

RecordLog reopen_rows(const fs::path& results, std::size_t columns, std::int64_t rows, const Sample* latest) {
  RecordLog log = open_rows(results, columns, rows);
  if (rows > 0 && latest != nullptr) {
    const std::vector<double> expected = row_of(*latest, columns);
    std::vector<double> there(columns);
    log.read(rows - 1, 1, there.data());
    if (std::memcmp(there.data(), expected.data(), columns * sizeof(double)) != 0)
      throw FileError(log.path().string() + ": row " + std::to_string(rows - 1) +
                      " is not the one that the checkpoint remembers: they are of different runs");
  }
  log.cut(rows);
  return log;
}

RecordLog unfold_snapshots(const fs::path& results, std::int64_t count) {
  const hdf5::File file = hdf5::File::open(results);
  const std::size_t there = read_snapshot_times(file).size();
  if (static_cast<std::int64_t>(there) < count) {
    throw FileError(results.string() + ": holds " + std::to_string(there) + " snapshots; to go on takes " +
                    std::to_string(count));
  }
  std::optional<RecordLog> log;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const Snapshot snapshot = read_snapshot(file, k);
    const std::vector<std::byte> record = pack(snapshot.table, snapshot.time);
    if (!log) log = RecordLog::create(beside(results, "snapshots.part.new"), snapshots_kind, record.size());
    log->append(record.data());
  }
  log->sync();
  log->rename(snapshots_path(results));
  return std::move(*log);
}

std::optional<RecordLog> reopen_snapshots(const fs::path& results, std::int64_t count) {
  const fs::path path = snapshots_path(results);
  if (count == 0) {
    remove_file(path);
    return std::nullopt;
  }
  if (!is_there(path)) return unfold_snapshots(results, count);
  RecordLog log = RecordLog::open(path, snapshots_kind, 0);
  if (log.count() < count) {
    throw FileError(path.string() + ": holds " + std::to_string(log.count()) + " whole snapshots; to go on takes " +
                    std::to_string(count));
  }
  log.cut(count);
  return log;
}

} // namespace

struct ResultsWriter::State {
  fs::path results;
  std::string scene_text;
  RecordLog rows;
  std::optional<RecordLog> snapshots; ///< none before the first
  std::vector<double> snapshot_times;
  std::size_t granules = 0; ///< in a snapshot
  std::optional<Snapshot> final_granules;
  bool new_since_fold = false;
  Clock::time_point folded;
  double fold_cost = 0.0; ///< s, of the last one

  State(fs::path path, std::string scene, RecordLog log, std::optional<RecordLog> earlier_snapshots)
      : results(std::move(path)), scene_text(std::move(scene)), rows(std::move(log)),
        snapshots(std::move(earlier_snapshots)) {
    for (std::int64_t k = 0; snapshots && k < snapshots->count(); ++k) {
      const Snapshot snapshot = read_snapshot(*snapshots, k);
      snapshot_times.push_back(snapshot.time);
      granules = snapshot.table.position.size();
    }
  }

  void fold(const std::function<bool()>& abandon = {}) {
    const Clock::time_point start = Clock::now();
    rows.flush();
    if (snapshots) snapshots->flush();
    RecordedRun run;
    run.scene_text = &scene_text;
    run.rows = &rows;
    run.snapshots = snapshots ? &*snapshots : nullptr;
    run.final_granules = final_granules ? &*final_granules : nullptr;
    run.abandon = abandon;
    write_results_file(results, run);
    if (snapshots)
      write_xdmf(xdmf_path(results), results.filename().string(), snapshot_times, granules);
    else
      remove_file(xdmf_path(results));
    new_since_fold = false;
    folded = Clock::now();
    fold_cost = std::chrono::duration<double>(folded - start).count();
  }
};

ResultsWriter::ResultsWriter(std::unique_ptr<State> state) : state_(std::move(state)) {
  state_->fold();
}

ResultsWriter::ResultsWriter(const fs::path& results, const std::string& scene_text, bool ledger)
    : ResultsWriter(std::make_unique<State>(
          results, scene_text,
          RecordLog::create(rows_path(results), history_kind, columns_with(ledger) * sizeof(double)),
          reopen_snapshots(results, 0))) {}

ResultsWriter ResultsWriter::go_on(const fs::path& results, const std::string& scene_text, bool ledger,
                                   const ResultsPosition& from, const Sample* latest) {
  return ResultsWriter(std::make_unique<State>(results, scene_text,
                                               reopen_rows(results, columns_with(ledger), from.rows, latest),
                                               reopen_snapshots(results, from.snapshots)));
}

ResultsWriter::~ResultsWriter() = default;
ResultsWriter::ResultsWriter(ResultsWriter&&) noexcept = default;
ResultsWriter& ResultsWriter::operator=(ResultsWriter&&) noexcept = default;

void ResultsWriter::append(const Sample& sample) {
  State& state = *state_;
  state.rows.append(row_of(sample, state.rows.record_bytes() / sizeof(double)).data());
  state.new_since_fold = true;
}

void ResultsWriter::append_snapshot(const GranuleTable& granules, double time) {
  State& state = *state_;
  const std::vector<std::byte> record = pack(granules, time);
  if (!state.snapshots)
    state.snapshots = RecordLog::create(snapshots_path(state.results), snapshots_kind, record.size());
  state.snapshots->append(record.data());
  state.snapshot_times.push_back(time);
  state.granules = granules.position.size();
  state.new_since_fold = true;
}

ResultsPosition ResultsWriter::position() const {
  return {state_->rows.count(), state_->snapshots ? state_->snapshots->count() : 0};
}

void ResultsWriter::sync() {
  state_->rows.sync();
  if (state_->snapshots) state_->snapshots->sync();
  sync_folder(state_->results.parent_path());
}

void ResultsWriter::fold() {
  state_->fold();
}

void ResultsWriter::fold_if_due(const std::function<bool()>& abandon) {
  if (!state_->new_since_fold) return;
  const double since = std::chrono::duration<double>(Clock::now() - state_->folded).count();
  if (since < std::max(least_between_folds, folds_apart * state_->fold_cost)) return;
  try {
    state_->fold(abandon);
  } catch (const FoldAbandoned&) {
    state_->folded = Clock::now();
  }
}

void ResultsWriter::write_final(const GranuleTable& granules, double time) {
  state_->final_granules = Snapshot{time, granules};
}

void ResultsWriter::close() {
  if (!state_) return;
  state_->fold();
  remove_file(state_->rows.path());
  if (state_->snapshots) remove_file(state_->snapshots->path());
  state_.reset();
}

} // namespace grandamp
