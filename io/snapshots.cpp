#include "io/snapshots.hpp"

#include "solver/errors.hpp"

#include <cmath>
#include <cstring>

namespace grandamp {
namespace {

using hdf5::Number;

struct Quantity {
  const char* name;
  const char* units;
  const char* description;
};

constexpr Quantity position{"position", "m", "centre, in the enclosure's frame"};
constexpr Quantity velocity{"velocity", "m/s", "of the centre, in the laboratory's frame"};
constexpr Quantity speed{"speed", "m/s", "magnitude of the velocity"};
constexpr Quantity spin{"spin", "rad/s", "angular velocity"};
constexpr Quantity radius{"radius", "m", "of the granule"};
constexpr Quantity population{"population", "1", "index of the scene's [[granules]] table, from 0"};
constexpr Quantity contacts{"contacts", "1", "with other granules and with walls, each"};

void describe(hdf5::File& file, const std::string& name, const Quantity& quantity) {
  file.set_attribute(name, "units", std::string(quantity.units));
  file.set_attribute(name, "description", std::string(quantity.description));
}

template <class T> void put(std::byte*& to, const std::vector<T>& values) {
  if (values.empty()) return;
  std::memcpy(to, values.data(), values.size() * sizeof(T));
  to += values.size() * sizeof(T);
}

template <class T> void take(const std::byte*& from, std::vector<T>& values, std::size_t count) {
  values.resize(count);
  if (count == 0) return;
  std::memcpy(values.data(), from, count * sizeof(T));
  from += count * sizeof(T);
}

constexpr std::size_t bytes_per_granule = 3 * sizeof(Vector3) + sizeof(double) + 2 * sizeof(std::int32_t);

std::vector<double> speeds_of(const GranuleTable& granules) {
  std::vector<double> speeds;
  speeds.reserve(granules.velocity.size());
  for (const Vector3& v : granules.velocity) speeds.push_back(std::hypot(v[0], v[1], v[2]));
  return speeds;
}

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

std::vector<std::int32_t> whole_numbers(const std::vector<double>& values) {
  std::vector<std::int32_t> numbers;
  numbers.reserve(values.size());
  for (const double value : values) numbers.push_back(static_cast<std::int32_t>(value));
  return numbers;
}

void require_alike(const GranuleTable& table, const std::string& where) {
  const std::size_t count = table.position.size();
  if (table.velocity.size() != count || table.spin.size() != count || table.radius.size() != count ||
      table.population.size() != count || table.contacts.size() != count)
    throw FileError(where + " is damaged: its members differ in length");
}

} // namespace

std::vector<std::byte> pack(const GranuleTable& granules, double time) {
  std::vector<std::byte> record(sizeof time + granules.position.size() * bytes_per_granule);
  std::byte* to = record.data();
  std::memcpy(to, &time, sizeof time);
  to += sizeof time;
  put(to, granules.position);
  put(to, granules.velocity);
  put(to, granules.spin);
  put(to, granules.radius);
  put(to, granules.population);
  put(to, granules.contacts);
  return record;
}

Snapshot unpack(const std::vector<std::byte>& record) {
  Snapshot snapshot;
  const std::byte* from = record.data();
  std::memcpy(&snapshot.time, from, sizeof snapshot.time);
  from += sizeof snapshot.time;
  const std::size_t count = (record.size() - sizeof snapshot.time) / bytes_per_granule;
  GranuleTable& table = snapshot.table;
  take(from, table.position, count);
  take(from, table.velocity, count);
  take(from, table.spin, count);
  take(from, table.radius, count);
  take(from, table.population, count);
  take(from, table.contacts, count);
  return snapshot;
}

Snapshot read_snapshot(const RecordLog& log, std::int64_t index) {
  std::vector<std::byte> record(log.record_bytes());
  log.read(index, 1, record.data());
  return unpack(record);
}

void write_snapshots(hdf5::File& file, const RecordLog& log) {
  Snapshot snapshot = read_snapshot(log, 0);
  const std::size_t granules = snapshot.table.position.size();
  const auto rows = static_cast<std::size_t>(log.count());
  file.create_group("/snapshots");
  const auto create = [&](const Quantity& quantity, Number type, const std::vector<std::size_t>& shape) {
    const std::string name = std::string("/snapshots/") + quantity.name;
    hdf5::Handle dataset = file.create_rows(name, type, shape, rows);
    describe(file, name, quantity);
    return dataset;
  };
  const hdf5::Handle times = create({"time", "s", "of each snapshot"}, Number::real64, {});
  const hdf5::Handle positions = create(position, Number::real64, {granules, 3});
  const hdf5::Handle velocities = create(velocity, Number::real64, {granules, 3});
  const hdf5::Handle speeds = create(speed, Number::real64, {granules});
  const hdf5::Handle spins = create(spin, Number::real64, {granules, 3});
  const hdf5::Handle counts = create(contacts, Number::integer32, {granules});
  for (std::size_t k = 0; k < rows; ++k) {
    if (k > 0) snapshot = read_snapshot(log, static_cast<std::int64_t>(k));
    const GranuleTable& table = snapshot.table;
    file.append(times, k, 1, Number::real64, &snapshot.time);
    file.append(positions, k, 1, Number::real64, table.position.data());
    file.append(velocities, k, 1, Number::real64, table.velocity.data());
    file.append(speeds, k, 1, Number::real64, speeds_of(table).data());
    file.append(spins, k, 1, Number::real64, table.spin.data());
    file.append(counts, k, 1, Number::integer32, table.contacts.data());
  }
  // These never change.
  file.write("/snapshots/radius", snapshot.table.radius);
  describe(file, "/snapshots/radius", radius);
  file.write("/snapshots/population", snapshot.table.population);
  describe(file, "/snapshots/population", population);
}

std::vector<double> read_snapshot_times(const hdf5::File& file) {
  return file.has("/snapshots/time") ? file.read_doubles("/snapshots/time") : std::vector<double>{};
}

Snapshot read_snapshot(const hdf5::File& file, std::size_t index) {
  Snapshot snapshot;
  snapshot.time = file.read_row("/snapshots/time", index).front();
  GranuleTable& table = snapshot.table;
  table.position = rows_of_three(file.read_row("/snapshots/position", index));
  table.velocity = rows_of_three(file.read_row("/snapshots/velocity", index));
  table.spin = rows_of_three(file.read_row("/snapshots/spin", index));
  table.contacts = whole_numbers(file.read_row("/snapshots/contacts", index));
  table.radius = file.read_doubles("/snapshots/radius");
  table.population = whole_numbers(file.read_doubles("/snapshots/population"));
  require_alike(table, file.path().string() + ": /snapshots");
  return snapshot;
}

void write_final_granules(hdf5::File& file, const Snapshot& granules) {
  const GranuleTable& table = granules.table;
  std::vector<std::int64_t> id(table.position.size());
  for (std::size_t i = 0; i < id.size(); ++i) id[i] = static_cast<std::int64_t>(i);
  file.create_group("/final");
  file.set_attribute("/final", "time", granules.time);
  file.write("/final/id", id);
  describe(file, "/final/id", {"id", "1", "number of the granule, in the scene's order"});
  const auto write = [&file](const Quantity& quantity, const auto& values, auto... width) {
    const std::string name = std::string("/final/") + quantity.name;
    file.write(name, values, width...);
    describe(file, name, quantity);
  };
  write(position, flat(table.position), std::size_t{3});
  write(velocity, flat(table.velocity), std::size_t{3});
  write(spin, flat(table.spin), std::size_t{3});
  write(radius, table.radius);
  write(population, table.population);
  write(contacts, table.contacts);
}

Snapshot read_final_granules(const hdf5::File& file) {
  Snapshot granules;
  granules.time = file.double_attribute("/final", "time");
  GranuleTable& table = granules.table;
  table.position = rows_of_three(file.read_doubles("/final/position"));
  table.velocity = rows_of_three(file.read_doubles("/final/velocity"));
  table.spin = rows_of_three(file.read_doubles("/final/spin"));
  table.radius = file.read_doubles("/final/radius");
  table.population = whole_numbers(file.read_doubles("/final/population"));
  table.contacts = whole_numbers(file.read_doubles("/final/contacts"));
  require_alike(table, file.path().string() + ": /final");
  return granules;
}

} // namespace grandamp
