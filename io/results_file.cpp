#include "io/results_file.hpp"

#include "io/hdf5.hpp"
#include "io/history_columns.hpp"
#include "io/snapshots.hpp"
#include "io/version.hpp"

#include <algorithm>

namespace grandamp {
namespace {

constexpr std::int64_t format_version = 2;
constexpr std::size_t rows_per_block = 4096;

void write_history(hdf5::File& file, const RecordLog& rows, const std::function<void()>& pulse) {
  file.create_group("/history");
  std::vector<hdf5::Handle> columns;
  for (const HistoryColumn& column : history_columns) {
    if (columns.size() == rows.record_bytes() / sizeof(double)) break; // the ledger's stand last
    const std::string name = std::string("/history/") + column.name;
    columns.push_back(file.create_column(name, static_cast<std::size_t>(rows.count())));
    file.set_attribute(name, "units", std::string(column.units));
    file.set_attribute(name, "description", std::string(column.description));
  }
  std::vector<double> block, values;
  for (std::int64_t first = 0; first < rows.count();) {
    const std::int64_t count = std::min<std::int64_t>(rows_per_block, rows.count() - first);
    block.resize(static_cast<std::size_t>(count) * columns.size());
    rows.read(first, count, block.data());
    values.resize(static_cast<std::size_t>(count));
    for (std::size_t c = 0; c < columns.size(); ++c) {
      for (std::size_t row = 0; row < values.size(); ++row) values[row] = block[row * columns.size() + c];
      file.append(columns[c], static_cast<std::size_t>(first), values);
    }
    first += count;
    pulse();
  }
  // The names that a force on the structure and one on the wall go by elsewhere.
  file.link("/history/excitation", "/history/force");
  file.link("/history/reaction", "/history/wall_force");
}

} // namespace

void write_results_file(const std::filesystem::path& path, const RecordedRun& run) {
  const auto pulse = [&run] {
    if (run.abandon && run.abandon()) throw FoldAbandoned{};
  };
  hdf5::File file = hdf5::File::create(path);
  file.set_attribute("/", "program", std::string("grandamp"));
  file.set_attribute("/", "version", version());
  file.set_attribute("/", "format_version", format_version);
  file.write("/scene", *run.scene_text);
  write_history(file, *run.rows, pulse);
  if (run.snapshots != nullptr && run.snapshots->count() > 0) write_snapshots(file, *run.snapshots, pulse);
  if (run.final_granules != nullptr) write_final_granules(file, *run.final_granules);
  file.close();
}

} // namespace grandamp
