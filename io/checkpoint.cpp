#include "io/checkpoint.hpp"

#include "io/hdf5.hpp"
#include "io/hdf5_seal.hpp"
#include "io/record_log.hpp"
#include "solver/errors.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

namespace grandamp {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t format_version = 7;

template <class SampleType, class Field> void visit_sample(SampleType& s, const std::string& group, Field&& field) {
  const auto one = [&](const char* name, const char* units, const char* description, auto& value) {
    field(group + name, units, description, std::size_t{1}, value);
  };
  one("time", "s", "of this sample", s.time);
  one("displacement", "m", "of the enclosure along its direction", s.displacement);
  one("velocity", "m/s", "of the enclosure along its direction", s.velocity);
  one("excitation", "N", "force on the structure", s.excitation);
  one("reaction", "N", "of the granules on the enclosure", s.reaction);
  one("kinetic", "J", "of the granules", s.stored.kinetic);
  one("gravitational", "J", "of the granules", s.stored.gravitational);
  one("elastic", "J", "of the contacts", s.stored.elastic);
  one("structure", "J", "of the host", s.stored.structure);
  one("contacts", "1", "between granules and with walls", s.contacts);
  one("work_in", "J", "since t = 0", s.ledger.work_in);
  one("structural_damping", "J", "since t = 0", s.ledger.structural_damping);
  one("normal_granule", "J", "since t = 0", s.ledger.normal_granule);
  one("normal_wall", "J", "since t = 0", s.ledger.normal_wall);
  one("friction_granule", "J", "since t = 0", s.ledger.friction_granule);
  one("friction_wall", "J", "since t = 0", s.ledger.friction_wall);
}

/// Calls field(path, units, description, width, value) for everything but the texts.
template <class CheckpointType, class Field> void visit(CheckpointType& checkpoint, Field&& field) {
  visit_fields(checkpoint.state, [&](const FieldInfo& info, auto& value) {
    field(std::string("/state/") + info.name, info.units, info.description, info.width, value);
  });
  auto& recording = checkpoint.recording;
  field("/recording/rows", "1", "of the histories", std::size_t{1}, recording.position.rows);
  field("/recording/snapshots", "1", "taken", std::size_t{1}, recording.position.snapshots);
  field("/recording/wall_time", "s", "from t = 0", std::size_t{1}, recording.wall_time);
  field("/recording/packing_wall_time", "s", "before t = 0", std::size_t{1}, recording.packing_wall_time);
  field("/recording/pouring", "1", "the state is of granules being poured", std::size_t{1}, recording.pouring);
  visit_sample(recording.initial, "/recording/initial/", field);
  visit_sample(recording.latest, "/recording/latest/", field);
}

/// Every group on the way to `path`.
void create_groups(hdf5::File& file, const std::string& path) {
  for (std::size_t slash = path.find('/', 1); slash != std::string::npos; slash = path.find('/', slash + 1)) {
    const std::string group = path.substr(0, slash);
    if (!file.has(group)) file.create_group(group);
  }
}

template <class Value> void write_value(hdf5::File& file, const std::string& path, std::size_t width, const Value& v) {
  if constexpr (std::is_same_v<Value, double>) {
    file.write(path, std::vector<double>{v});
  } else if constexpr (std::is_arithmetic_v<Value>) {
    file.write(path, std::vector<std::int64_t>{static_cast<std::int64_t>(v)});
  } else if constexpr (std::is_same_v<Value, std::vector<double>> || std::is_same_v<Value, std::vector<float>>) {
    file.write(path, v, width);
  } else { // rows and ids are far below 2^31
    file.write(path, std::vector<std::int32_t>(v.begin(), v.end()));
  }
}

/// The values of a dataset, each of which must be one of `Number`.
template <class Number> std::vector<Number> read_whole_numbers(const hdf5::File& file, const std::string& path) {
  const std::vector<std::int64_t> values = file.read_integers(path);
  std::vector<Number> result;
  result.reserve(values.size());
  for (const std::int64_t value : values) {
    if (!std::in_range<Number>(value))
      throw FileError(fmt::format("{}: {} holds {}", file.path().string(), path, value));
    result.push_back(static_cast<Number>(value));
  }
  return result;
}

template <class Value> void read_value(const hdf5::File& file, const std::string& path, Value& value) {
  const auto single = [&](const auto& values) {
    if (values.size() != 1)
      throw FileError(fmt::format("{}: {} holds {} values instead of one", file.path().string(), path, values.size()));
    return values.front();
  };
  if constexpr (std::is_same_v<Value, double>) {
    value = single(file.read_doubles(path));
  } else if constexpr (std::is_same_v<Value, std::int64_t>) {
    value = single(file.read_integers(path));
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = single(file.read_integers(path)) != 0;
  } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
    value = file.read_doubles(path);
  } else if constexpr (std::is_same_v<Value, std::vector<float>>) {
    value = file.read_floats(path);
  } else {
    value = read_whole_numbers<typename Value::value_type>(file, path);
  }
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw FileError(to.string() + ": cannot replace the file: " + error.message());
}

/// For tests alone: GRANDAMP_TEST_CHECKPOINT_DELAY, in milliseconds, makes the moments long in which a kill finds a
/// checkpoint half written or between its places.
void dawdle() {
  static const char* const asked = std::getenv("GRANDAMP_TEST_CHECKPOINT_DELAY");
  if (asked != nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(std::strtol(asked, nullptr, 10)));
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

} // namespace

CheckpointFiles::CheckpointFiles(const fs::path& folder)
    : newest(folder / "checkpoint.h5"), previous(folder / "checkpoint.previous.h5"),
      next(folder / "checkpoint.next.h5") {}

bool CheckpointFiles::any() const {
  std::error_code error;
  return fs::exists(next, error) || fs::exists(newest, error) || fs::exists(previous, error);
}

void CheckpointFiles::settle() {
  std::error_code error;
  if (!fs::exists(next, error)) return;
  if (fs::exists(newest, error) && !std::exchange(newest_is_damaged, false)) move(newest, previous);
  dawdle();
  move(next, newest);
  sync_folder(newest.parent_path());
}

void CheckpointFiles::remove() const {
  for (const fs::path& file : {next, newest, previous}) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw FileError(file.string() + ": cannot remove the file of the earlier run: " + error.message());
  }
}

void write_checkpoint(CheckpointFiles& files, const Checkpoint& checkpoint) {
  hdf5::File file = hdf5::File::create(files.next);
  file.set_attribute("/", "program", std::string("grandamp"));
  file.set_attribute("/", "content", std::string("checkpoint"));
  file.set_attribute("/", "format_version", format_version);
  file.set_attribute("/", "version", checkpoint.version);
  file.set_attribute("/", "isa", checkpoint.isa);
  file.set_attribute("/", "time", static_cast<double>(checkpoint.state.step_number) * checkpoint.state.time_step);
  file.write("/scene", checkpoint.scene);
  file.write("/overrides", joined(checkpoint.overrides));
  visit(checkpoint,
        [&file](const std::string& path, const char* units, const char* description, std::size_t width, auto& value) {
          create_groups(file, path);
          write_value(file, path, width, value);
          file.set_attribute(path, "units", std::string(units));
          file.set_attribute(path, "description", std::string(description));
        });
  dawdle();
  file.close();
  dawdle();
  files.settle();
}

Checkpoint read_checkpoint(const fs::path& path) {
  const hdf5::SealReport seal = hdf5::check_seal(path);
  if (seal.state != hdf5::SealReport::State::whole) throw FileError(path.string() + ": damaged: " + seal.what);
  try {
    const hdf5::File file = hdf5::File::open_at_risk(path);
    if (file.text_attribute("/", "content") != "checkpoint")
      throw FileError(path.string() + ": is no checkpoint, though it is a file of grandamp");
    if (const double format = file.double_attribute("/", "format_version"); format != format_version)
      throw OtherFormat(fmt::format("{}: a checkpoint of format {}, where this program reads format {}: go on with the "
                                    "program that wrote it, grandamp {}",
                                    path.string(), format, format_version, file.text_attribute("/", "version")));
    Checkpoint checkpoint;
    checkpoint.version = file.text_attribute("/", "version");
    checkpoint.isa = file.text_attribute("/", "isa");
    checkpoint.scene = file.read_text("/scene");
    checkpoint.overrides = split(file.read_text("/overrides"));
    visit(checkpoint, [&file](const std::string& name, const char*, const char*, std::size_t, auto& value) {
      read_value(file, name, value);
    });
    return checkpoint;
  } catch (const std::bad_alloc&) {
    throw FileError(path.string() + ": is too large for this machine's memory");
  } catch (const std::length_error&) {
    throw FileError(path.string() + ": holds an array of impossible size");
  }
}

FoundCheckpoint find_checkpoint(const CheckpointFiles& files) {
  FoundCheckpoint found;
  for (const fs::path& file : {files.next, files.newest, files.previous}) {
    std::error_code error;
    if (!fs::exists(file, error)) continue;
    try {
      found.checkpoint = read_checkpoint(file);
      found.file = file;
      return found;
    } catch (const OtherFormat&) {
      throw;
    } catch (const FileError& what) {
      if (file == files.newest) found.newest_is_damaged = true;
      found.damaged.emplace_back(what.what());
    }
  }
  std::string reasons;
  for (const std::string& reason : found.damaged) reasons += "; " + reason;
  throw FileError(files.newest.parent_path().string() +
                  (found.damaged.empty()
                       ? ": holds no checkpoint, so there is nothing to go on from; start the run anew"
                       : ": holds no checkpoint that can be used" + reasons));
}

} // namespace grandamp
