#include "io/hdf5.hpp"
#include "io/history_columns.hpp"
#include "io/results.hpp"
#include "solver/errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace grandamp {
namespace {

namespace fs = std::filesystem;

/// A log beside the results file, if there is one.
std::optional<RecordLog> log_beside(const fs::path& results, const char* name, std::string_view kind) {
  const fs::path path = results.parent_path() / name;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  return RecordLog::open(path, kind, 0, true);
}

/// `places`: of the history's columns among the log's `width`.
void append_rows(History& history, const std::vector<std::size_t>& places, std::size_t width, const RecordLog& log) {
  if (log.record_bytes() != width * sizeof(double))
    throw FileError(log.path().string() + ": does not belong to the results beside it: its rows have another width");
  const auto known = static_cast<std::int64_t>(history.columns.front().size());
  if (log.count() <= known) return;
  std::vector<double> block(static_cast<std::size_t>(log.count() - known) * width);
  log.read(known, log.count() - known, block.data());
  for (std::size_t c = 0; c < places.size(); ++c)
    for (std::size_t at = places[c]; at < block.size(); at += width) history.columns[c].push_back(block[at]);
}

} // namespace

History read_history(const fs::path& path, const std::vector<std::string>& only) {
  const hdf5::File file = hdf5::File::open(path);
  if (!file.has("/history")) throw FileError(path.string() + ": holds no histories; not a results file of grandamp");
  History history;
  std::vector<std::size_t> places;
  std::size_t width = 0;
  for (const HistoryColumn& column : history_columns) {
    const std::string name = std::string("/history/") + column.name;
    if (!file.has(name)) continue;
    const std::size_t place = width++;
    if (!only.empty() && std::find(only.begin(), only.end(), column.name) == only.end()) continue;
    places.push_back(place);
    history.names.emplace_back(column.name);
    history.columns.push_back(file.read_doubles(name));
    if (history.columns.back().size() != history.columns.front().size())
      throw FileError(path.string() + ": /history is damaged: its members differ in length");
  }
  if (const auto log = log_beside(path, "history.part", history_kind); log && !history.columns.empty())
    append_rows(history, places, width, *log);
  return history;
}

Snapshot read_final_granules(const fs::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  if (!file.has("/final"))
    throw FileError(path.string() + ": holds no granules at the end; the run was stopped before it came there");
  return read_final_granules(file);
}

struct SnapshotReader::State {
  explicit State(const fs::path& path)
      : file(hdf5::File::open(path)), log(log_beside(path, "snapshots.part", snapshots_kind)),
        times(read_snapshot_times(file)), folded(times.size()) {
    for (auto k = static_cast<std::int64_t>(folded); log && k < log->count(); ++k)
      times.push_back(grandamp::read_snapshot(*log, k).time);
  }
  hdf5::File file;
  std::optional<RecordLog> log;
  std::vector<double> times;
  std::size_t folded; ///< the first ones, in the file
};

SnapshotReader::SnapshotReader(const fs::path& path) : state_(std::make_unique<State>(path)) {}
SnapshotReader::~SnapshotReader() = default;

const std::vector<double>& SnapshotReader::times() const {
  return state_->times;
}

Snapshot SnapshotReader::read(std::size_t index) const {
  return index < state_->folded ? read_snapshot(state_->file, index)
                                : read_snapshot(*state_->log, static_cast<std::int64_t>(index));
}

std::optional<Snapshot> read_snapshot_near(const fs::path& path, double time) {
  const SnapshotReader snapshots(path);
  const std::vector<double>& times = snapshots.times();
  if (times.empty()) return std::nullopt;
  const auto nearest = std::min_element(times.begin(), times.end(),
                                        [time](double a, double b) { return std::abs(a - time) < std::abs(b - time); });
  const hdf5::File& file = snapshots.state_->file;
  if (file.has("/final") && std::abs(file.double_attribute("/final", "time") - time) < std::abs(*nearest - time))
    return read_final_granules(file);
  return snapshots.read(static_cast<std::size_t>(nearest - times.begin()));
}

std::string read_stored_scene(const fs::path& path) {
  return hdf5::File::open(path).read_text("/scene");
}

} // namespace grandamp
