#include "io/snapshots.hpp"

#include "solver/errors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace grandamp {
namespace {

struct Quantity {
  const char* name;
  const char* units;
  const char* description;
};

constexpr Quantity id{"id", "1", "number of the granule, in the scene's order"};
constexpr Quantity position{"position", "m", "centre, in the enclosure's frame"};
constexpr Quantity velocity{"velocity", "m/s", "of the centre, in the laboratory's frame"};
constexpr Quantity speed{"speed", "m/s", "magnitude of the velocity"};
constexpr Quantity spin{"spin", "rad/s", "angular velocity"};
constexpr Quantity radius{"radius", "m", "of the granule"};
constexpr Quantity population{"population", "1", "index of the scene's [[granules]] table, from 0"};
constexpr Quantity contacts{"contacts", "1", "with other granules and with walls, each"};

template <class Values, class... Width>
void write(hdf5::File& file, const std::string& group, const Quantity& quantity, const Values& values, Width... width) {
  const std::string name = group + "/" + quantity.name;
  file.write(name, values, static_cast<std::size_t>(width)...);
  file.set_attribute(name, "units", std::string(quantity.units));
  file.set_attribute(name, "description", std::string(quantity.description));
}

std::string snapshot_group(std::size_t index) {
  return fmt::format("/snapshots/{:06}", index);
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

std::vector<std::int64_t> ids_of(const GranuleTable& table) {
  std::vector<std::int64_t> ids(table.position.size());
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::int64_t>(i);
  return ids;
}

/// What moves is in one group, what never changes in another or in the same.
Snapshot read_granules(const hdf5::File& file, const std::string& moving, const std::string& constant) {
  Snapshot granules;
  granules.time = file.double_attribute(moving, "time");
  GranuleTable& table = granules.table;
  table.position = rows_of_three(file.read_doubles(moving + "/position"));
  table.velocity = rows_of_three(file.read_doubles(moving + "/velocity"));
  table.spin = rows_of_three(file.read_doubles(moving + "/spin"));
  table.contacts = whole_numbers(file.read_doubles(moving + "/contacts"));
  table.radius = file.read_doubles(constant + "/radius");
  table.population = whole_numbers(file.read_doubles(constant + "/population"));
  const std::size_t count = table.position.size();
  if (table.velocity.size() != count || table.spin.size() != count || table.radius.size() != count ||
      table.population.size() != count || table.contacts.size() != count)
    throw FileError(file.path().string() + ": " + moving + " is damaged: its members differ in length");
  return granules;
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

void write_snapshots(hdf5::File& file, const RecordLog& log, const std::function<void()>& pulse) {
  file.create_group("/snapshots");
  std::vector<double> times;
  for (std::int64_t k = 0; k < log.count(); ++k) {
    const Snapshot snapshot = read_snapshot(log, k);
    const GranuleTable& table = snapshot.table;
    if (k == 0) { // what never changes
      write(file, "/snapshots", id, ids_of(table));
      write(file, "/snapshots", radius, table.radius);
      write(file, "/snapshots", population, table.population);
    }
    const std::string group = snapshot_group(static_cast<std::size_t>(k));
    file.create_group(group);
    file.set_attribute(group, "time", snapshot.time);
    write(file, group, position, flat(table.position), 3);
    write(file, group, velocity, flat(table.velocity), 3);
    write(file, group, spin, flat(table.spin), 3);
    write(file, group, speed, speeds_of(table));
    write(file, group, contacts, table.contacts);
    times.push_back(snapshot.time);
    pulse();
  }
  write(file, "/snapshots", {"time", "s", "of each snapshot"}, times);
}

std::vector<double> read_snapshot_times(const hdf5::File& file) {
  return file.has("/snapshots/time") ? file.read_doubles("/snapshots/time") : std::vector<double>{};
}

Snapshot read_snapshot(const hdf5::File& file, std::size_t index) {
  const std::string group = snapshot_group(index);
  return read_granules(file, group, "/snapshots");
}

void write_final_granules(hdf5::File& file, const Snapshot& granules) {
  const GranuleTable& table = granules.table;
  const std::string group = "/final";
  file.create_group(group);
  file.set_attribute(group, "time", granules.time);
  write(file, group, id, ids_of(table));
  write(file, group, position, flat(table.position), 3);
  write(file, group, velocity, flat(table.velocity), 3);
  write(file, group, spin, flat(table.spin), 3);
  write(file, group, radius, table.radius);
  write(file, group, population, table.population);
  write(file, group, contacts, table.contacts);
}

Snapshot read_final_granules(const hdf5::File& file) {
  return read_granules(file, "/final", "/final");
}

} // namespace grandamp
