#include "io/results.hpp"

#include "io/history_columns.hpp"
#include "io/results_file.hpp"
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

constexpr std::string_view rows_kind = "history";
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
  RecordLog log = RecordLog::create(fresh, rows_kind, columns * sizeof(double));
  std::vector<double> row(columns);
  for (std::size_t k = 0; k < static_cast<std::size_t>(rows); ++k) {
    for (std::size_t c = 0; c < columns; ++c) row[c] = history.columns[c][k];
    log.append(row.data());
  }
  log.sync();
  log.rename(rows_path(results));
  return log;
}

RecordLog reopen_rows(const fs::path& results, std::size_t columns, std::int64_t rows) {
  const fs::path path = rows_path(results);
  if (is_there(path)) {
    RecordLog log = RecordLog::open(path, rows_kind, columns * sizeof(double));
    if (log.count() < rows) {
      throw FileError(path.string() + ": holds " + std::to_string(log.count()) + " whole rows; to go on takes " +
                      std::to_string(rows));
    }
    log.cut(rows);
    return log;
  }
  return unfold_rows(results, columns, rows);
}

} // namespace

struct ResultsWriter::State {
  fs::path results;
  std::string scene_text;
  RecordLog rows;
  std::optional<FinalGranules> final_granules;
  std::vector<double> row;
  bool new_since_fold = false;
  Clock::time_point folded;
  double fold_cost = 0.0; ///< s, of the last one

  State(fs::path path, std::string scene, RecordLog log)
      : results(std::move(path)), scene_text(std::move(scene)), rows(std::move(log)) {
    row.resize(rows.record_bytes() / sizeof(double));
  }

  void fold() {
    const Clock::time_point start = Clock::now();
    rows.flush();
    RecordedRun run;
    run.scene_text = &scene_text;
    run.rows = &rows;
    run.final_granules = final_granules ? &*final_granules : nullptr;
    write_results_file(results, run);
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
          RecordLog::create(rows_path(results), rows_kind, columns_with(ledger) * sizeof(double)))) {}

ResultsWriter ResultsWriter::go_on(const fs::path& results, const std::string& scene_text, bool ledger,
                                   const ResultsPosition& from) {
  return ResultsWriter(
      std::make_unique<State>(results, scene_text, reopen_rows(results, columns_with(ledger), from.rows)));
}

ResultsWriter::~ResultsWriter() = default;
ResultsWriter::ResultsWriter(ResultsWriter&&) noexcept = default;
ResultsWriter& ResultsWriter::operator=(ResultsWriter&&) noexcept = default;

void ResultsWriter::append(const Sample& sample) {
  State& state = *state_;
  for (std::size_t c = 0; c < state.row.size(); ++c) state.row[c] = history_columns[c].value(sample);
  state.rows.append(state.row.data());
  state.new_since_fold = true;
}

ResultsPosition ResultsWriter::position() const {
  return {state_->rows.count(), 0};
}

void ResultsWriter::sync() {
  state_->rows.sync();
}

void ResultsWriter::fold() {
  state_->fold();
}

void ResultsWriter::fold_if_due() {
  if (!state_->new_since_fold) return;
  const double since = std::chrono::duration<double>(Clock::now() - state_->folded).count();
  if (since >= std::max(least_between_folds, folds_apart * state_->fold_cost)) state_->fold();
}

void ResultsWriter::write_final(const GranuleTable& granules, double time) {
  state_->final_granules = FinalGranules{time, granules};
}

void ResultsWriter::close() {
  if (!state_) return;
  state_->fold();
  remove_file(state_->rows.path());
  state_.reset();
}

} // namespace grandamp
