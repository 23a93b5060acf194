#include "io/hdf5.hpp"
#include "io/results.hpp"
#include "solver/errors.hpp"

#include <algorithm>

namespace grandamp {
namespace {

std::vector<Vector3> rows_of_three(const std::vector<double>& values) {
  std::vector<Vector3> rows(values.size() / 3);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return rows;
}

} // namespace

History read_history(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  if (!file.has("/history")) throw FileError(path.string() + ": holds no histories; not a results file of grandamp");
  History history;
  history.names = file.members("/history");
  std::size_t rows = 0;
  for (const std::string& name : history.names) {
    history.columns.push_back(file.read_doubles("/history/" + name));
    rows = history.columns.size() == 1 ? history.columns.back().size() : std::min(rows, history.columns.back().size());
  }
  // A run cut while a block was written may leave the first columns longer.
  for (auto& column : history.columns) column.resize(rows);
  return history;
}

FinalGranules read_final_granules(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  if (!file.has("/final")) {
    throw FileError(path.string() + ": holds no granules at the end; the run was stopped before it came there");
  }
  FinalGranules granules;
  granules.time = file.double_attribute("/final", "time");
  granules.table.position = rows_of_three(file.read_doubles("/final/position"));
  granules.table.velocity = rows_of_three(file.read_doubles("/final/velocity"));
  granules.table.spin = rows_of_three(file.read_doubles("/final/spin"));
  granules.table.radius = file.read_doubles("/final/radius");
  for (const std::int64_t population : file.read_integers("/final/population")) {
    granules.table.population.push_back(static_cast<std::int32_t>(population));
  }
  const std::size_t count = granules.table.position.size();
  if (granules.table.velocity.size() != count || granules.table.spin.size() != count ||
      granules.table.radius.size() != count || granules.table.population.size() != count) {
    throw FileError(path.string() + ": /final is damaged: its members differ in length");
  }
  return granules;
}

std::string read_stored_scene(const std::filesystem::path& path) {
  return hdf5::File::open(path).read_text("/scene");
}

} // namespace grandamp
