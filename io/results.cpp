#include "io/results.hpp"

#include "io/hdf5.hpp"
#include "io/version.hpp"
#include "solver/errors.hpp"

#include <algorithm>
#include <array>

namespace grandamp {
namespace {

constexpr std::int64_t format_version = 1;
constexpr std::size_t rows_per_block = 1024;

struct Column {
  const char* name;
  const char* units;
  const char* description;
  bool of_ledger;
  double (*value)(const Sample&);
};

constexpr std::array columns{
    Column{"time", "s", "time since the start of the run", false, [](const Sample& s) { return s.time; }},
    Column{"displacement", "m", "of the enclosure along its direction, from the equilibrium without granules", false,
           [](const Sample& s) { return s.displacement; }},
    Column{"velocity", "m/s", "of the enclosure along its direction", false,
           [](const Sample& s) { return s.velocity; }},
    Column{"excitation", "N", "force on the structure along its direction", false,
           [](const Sample& s) { return s.excitation; }},
    Column{"reaction", "N", "force of the granules on the enclosure along its direction", false,
           [](const Sample& s) { return s.reaction; }},
    Column{"kinetic", "J", "of the granules, translation and rotation, in the laboratory's frame", false,
           [](const Sample& s) { return s.stored.kinetic; }},
    Column{"elastic", "J", "stored in contacts", false, [](const Sample& s) { return s.stored.elastic; }},
    Column{"gravitational", "J", "of the granules, from the laboratory height of the enclosure's origin at x = 0",
           false, [](const Sample& s) { return s.stored.gravitational; }},
    Column{"contacts", "1", "contacts between granules and with the enclosure", false,
           [](const Sample& s) { return static_cast<double>(s.contacts); }},
    Column{"work_in", "J", "work of the excitation since t = 0", true,
           [](const Sample& s) { return s.ledger.work_in; }},
    Column{"structural_damping", "J", "lost in the structure's own damper since t = 0", true,
           [](const Sample& s) { return s.ledger.structural_damping; }},
    Column{"normal_granule", "J", "lost to normal damping between granules since t = 0", true,
           [](const Sample& s) { return s.ledger.normal_granule; }},
    Column{"normal_wall", "J", "lost to normal damping at the enclosure since t = 0", true,
           [](const Sample& s) { return s.ledger.normal_wall; }},
    Column{"friction_granule", "J", "lost to friction between granules since t = 0", true,
           [](const Sample& s) { return s.ledger.friction_granule; }},
    Column{"friction_wall", "J", "lost to friction at the enclosure since t = 0", true,
           [](const Sample& s) { return s.ledger.friction_wall; }},
    Column{"structure", "J", "kinetic and spring energy of the host structure", true,
           [](const Sample& s) { return s.stored.structure; }},
};

std::vector<double> flat(const std::vector<Vector3>& rows) {
  std::vector<double> values;
  values.reserve(3 * rows.size());
  for (const Vector3& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

std::vector<Vector3> rows_of_three(const std::vector<double>& values) {
  std::vector<Vector3> rows(values.size() / 3);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return rows;
}

} // namespace

struct ResultsWriter::State {
  struct Open {
    const Column* column;
    hdf5::Handle dataset;
    std::vector<double> waiting;
  };

  // Datasets stand after the file, so that they are closed before it.
  hdf5::File file;
  std::vector<Open> open;
  std::size_t written = 0;

  void write_block() {
    if (open.front().waiting.empty()) return;
    for (Open& each : open) file.append(each.dataset, written, each.waiting);
    written += open.front().waiting.size();
    for (Open& each : open) each.waiting.clear();
  }
};

ResultsWriter::ResultsWriter(const std::filesystem::path& path, const std::string& scene_text, bool ledger)
    : state_(new State{hdf5::File::create(path), {}, 0}) {
  hdf5::File& file = state_->file;
  file.set_attribute("/", "program", std::string("grandamp"));
  file.set_attribute("/", "version", version());
  file.set_attribute("/", "format_version", format_version);
  file.write("/scene", scene_text);
  file.create_group("/history");
  for (const Column& column : columns) {
    if (column.of_ledger && !ledger) continue;
    const std::string name = std::string("/history/") + column.name;
    state_->open.push_back({&column, file.create_column(name, rows_per_block), {}});
    state_->open.back().waiting.reserve(rows_per_block);
    file.set_attribute(name, "units", std::string(column.units));
    file.set_attribute(name, "description", std::string(column.description));
  }
  file.flush();
}

ResultsWriter::~ResultsWriter() = default;
ResultsWriter::ResultsWriter(ResultsWriter&&) noexcept = default;
ResultsWriter& ResultsWriter::operator=(ResultsWriter&&) noexcept = default;

void ResultsWriter::append(const Sample& sample) {
  for (auto& each : state_->open) each.waiting.push_back(each.column->value(sample));
  if (state_->open.front().waiting.size() >= rows_per_block) state_->write_block();
}

void ResultsWriter::flush() {
  state_->write_block();
  state_->file.flush();
}

void ResultsWriter::write_final(const GranuleTable& granules, double time) {
  hdf5::File& file = state_->file;
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

void ResultsWriter::close() {
  if (!state_) return;
  state_->write_block();
  for (auto& each : state_->open) each.dataset.close();
  state_->file.close();
  state_.reset();
}

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
