#include "io/results_file.hpp"

#include "io/hdf5.hpp"
#include "io/history_columns.hpp"
#include "io/version.hpp"

#include <algorithm>

namespace grandamp {
namespace {

constexpr std::int64_t format_version = 1;
constexpr std::size_t rows_per_block = 4096;

std::vector<double> flat(const std::vector<Vector3>& rows) {
  std::vector<double> values;
  values.reserve(3 * rows.size());
  for (const Vector3& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

/// Short histories take little room, long ones few chunks.
std::size_t chunk_for(std::int64_t rows) {
  std::size_t chunk = 64;
  while (chunk < 16384 && static_cast<std::int64_t>(chunk) < rows) chunk *= 2;
  return chunk;
}

void write_history(hdf5::File& file, const RecordLog& rows) {
  file.create_group("/history");
  std::vector<hdf5::Handle> columns;
  for (const HistoryColumn& column : history_columns) {
    if (columns.size() == rows.record_bytes() / sizeof(double)) break; // the ledger's stand last
    const std::string name = std::string("/history/") + column.name;
    columns.push_back(file.create_column(name, chunk_for(rows.count())));
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
  }
}

void write_granules(hdf5::File& file, const GranuleTable& granules, double time) {
  const std::size_t count = granules.position.size();
  std::vector<std::int64_t> id(count);
  for (std::size_t i = 0; i < count; ++i) id[i] = static_cast<std::int64_t>(i);
  file.create_group("/final");
  file.set_attribute("/final", "time", time);
  file.write("/final/id", id);
  file.write("/final/position", flat(granules.position), 3);
  file.write("/final/velocity", flat(granules.velocity), 3);
  file.write("/final/spin", flat(granules.spin), 3);
  file.write("/final/radius", granules.radius);
  file.write("/final/population", std::vector<std::int64_t>(granules.population.begin(), granules.population.end()));
  const auto describe = [&file](const std::string& name, const std::string& units, const std::string& description) {
    file.set_attribute("/final/" + name, "units", units);
    file.set_attribute("/final/" + name, "description", description);
  };
  describe("id", "1", "number of the granule, in the scene's order");
  describe("position", "m", "centre, in the enclosure's frame");
  describe("velocity", "m/s", "of the centre, in the laboratory's frame");
  describe("spin", "rad/s", "angular velocity");
  describe("radius", "m", "of the granule");
  describe("population", "1", "index of the scene's [[granules]] table, from 0");
}

} // namespace

void write_results_file(const std::filesystem::path& path, const RecordedRun& run) {
  hdf5::File file = hdf5::File::create(path);
  file.set_attribute("/", "program", std::string("grandamp"));
  file.set_attribute("/", "version", version());
  file.set_attribute("/", "format_version", format_version);
  file.write("/scene", *run.scene_text);
  write_history(file, *run.rows);
  if (run.final_granules != nullptr) write_granules(file, run.final_granules->table, run.final_granules->time);
  file.close();
}

} // namespace grandamp
