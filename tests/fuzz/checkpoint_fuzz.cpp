// Any file is either a checkpoint or a FileError that says why not; and what is read of it is either a state that may
// be stepped or a StateError. The first byte of an input chooses the damage to a good file:
//   0  the rest of the input is the file;
//   1  bytes of the good file are changed: the seal must tell;
//   2  objects of the good file are taken out or replaced by others of any type, shape and value, and it is sealed
//   anew,
//      so that what lies behind the seal is reached.
#include "io/checkpoint.hpp"
#include "io/hdf5.hpp"
#include "io/hdf5_seal.hpp"
#include "io/scene_file.hpp"
#include "solver/list_state.hpp"
#include "solver/plan.hpp"
#include "solver/run_state.hpp"

#include <fcntl.h>
#include <fuzzer/FuzzedDataProvider.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace grandamp;

namespace {

namespace fs = std::filesystem;

constexpr const char* scene_text = R"(gravity = [0.0, 0.0, -9.81]
[enclosure]
shape = "box"
size = [0.01, 0.01, 0.01]
[[granules]]
name = "acrylic"
density = 1190.0
radius = 1.0e-3
positions = [[0.003, 0.005, 0.005], [0.0055, 0.005, 0.005]]
[contact]
friction = "spring"
[contact.granule]
stiffness = 1.0e7
tangential_stiffness = 0.9e7
reference_radius = 3.0e-3
restitution = 0.89
friction = 0.52
[time]
duration = 0.01
step = 1.0e-6
impact_speed = 1.0
[verlet]
policy = "displacement"
)";

void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

void demand_message(const std::string& message) {
  demand(!message.empty(), "there is a message");
}

/// Two granules, one pair, one row near the first wall and touching it, one loaded spring.
Checkpoint good_checkpoint(const Plan& plan) {
  Checkpoint checkpoint;
  checkpoint.version = "0";
  checkpoint.isa = "generic";
  checkpoint.scene = scene_text;
  checkpoint.overrides = {"time.duration=0.02", "output.history_interval=1e-3"};
  RunState& s = checkpoint.state;
  s.step_number = 7;
  s.steps = plan.steps;
  s.time_step = plan.time_step;
  s.window = plan.window;
  s.same_sizes = true;
  s.constants = {1.0, 2.0, 3.0};
  s.id = {1, 0};
  s.population = {0, 0};
  s.position = {0.0055, 0.005, 0.005, 0.003, 0.005, 0.005};
  s.radius = {1.0e-3, 1.0e-3};
  s.inverse_mass = {2.0e5, 2.0e5};
  s.velocity = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  s.surface_spin = {0.5, 0.4, 0.3, 0.2, 0.1, 0.0};
  for (auto* ledger : {&s.velocity_rate, &s.surface_spin_rate, &s.damping_granule, &s.friction_granule})
    ledger->assign(s.velocity.begin(), s.velocity.end());
  s.at_wall = {1};
  s.damping_wall = s.friction_wall = s.friction_wall_turn = {0.1, 0.2, 0.3};
  s.list.segment_rows = {0, 2};
  s.list.segment_blocks = {1};
  s.list.block_rows = {0, 2};
  s.list.class_pairs.assign(2 * gap_classes, 0);
  s.list.class_pairs[0] = 1;
  s.list.pairs = {0, 1};
  s.list.wall_counts = {1, 0, 0, 0, 0, 0};
  s.list.wall_rows = {1};
  s.spring_contacts = {0, 1};
  s.springs = {1.0, 2.0, 3.0, 4.0};
  s.built_at = s.position;
  s.skin = 1.0e-4;
  s.list_built = true;
  s.response_amplitudes = {1.0e-3};
  s.vibration_cycles.assign(20, 0.5);
  return checkpoint;
}

/// Everything that is made once.
struct Bench {
  Bench() : plan(make_plan(read_scene_text(scene_text, "fuzz.toml").scene)) {
    std::string name = fs::exists("/dev/shm") ? "/dev/shm/grandamp-fuzz-XXXXXX" : "/tmp/grandamp-fuzz-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) std::abort();
    folder = name;
    CheckpointFiles files(folder);
    write_checkpoint(files, good_checkpoint(plan));
    file = files.newest;
    std::ifstream in(file, std::ios::binary);
    good.assign(std::istreambuf_iterator<char>(in), {});
    const Checkpoint again = read_checkpoint(file);
    check_state(again.state, plan);
    visit_fields(again.state,
                 [this](const FieldInfo& info, const auto&) { names.push_back(std::string("/state/") + info.name); });
    for (const char* object : {"/scene", "/overrides", "/recording/rows", "/recording/wall_time", "/recording/pouring",
                               "/recording/latest/time", "/recording/initial/contacts", "/state", "/recording"})
      names.emplace_back(object);
  }
  ~Bench() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  Plan plan;
  fs::path folder, file;
  std::string good;
  std::vector<std::string> names; ///< of objects
};

void put(const fs::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

hdf5::Handle any_type(FuzzedDataProvider& data, bool& text) {
  text = false;
  switch (data.ConsumeIntegralInRange(0, 8)) {
  case 0:
    return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
  case 1:
    return {H5Tcopy(H5T_NATIVE_INT64), H5Tclose};
  case 2:
    return {H5Tcopy(H5T_NATIVE_INT32), H5Tclose};
  case 3:
    return {H5Tcopy(H5T_NATIVE_FLOAT), H5Tclose};
  case 4:
    return {H5Tcopy(H5T_STD_U64BE), H5Tclose};
  case 5: {
    hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id(), data.ConsumeIntegralInRange<std::size_t>(1, 40));
    return type;
  }
  case 6: {
    hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id(), H5T_VARIABLE);
    text = true;
    return type;
  }
  case 7:
    return {H5Tcreate(H5T_OPAQUE, 16), H5Tclose};
  default: {
    hdf5::Handle type(H5Tcreate(H5T_COMPOUND, 24), H5Tclose);
    H5Tinsert(type.id(), "a", 0, H5T_NATIVE_DOUBLE);
    H5Tinsert(type.id(), "b", 8, H5T_NATIVE_INT32);
    return type;
  }
  }
}

hdf5::Handle any_space(FuzzedDataProvider& data, hsize_t& points) {
  const int rank = data.ConsumeIntegralInRange(0, 3);
  hsize_t dims[3] = {0, 0, 0};
  points = 1;
  for (int k = 0; k < rank; ++k) points *= dims[k] = data.ConsumeIntegralInRange<hsize_t>(0, 7);
  if (rank == 0) return {H5Screate(data.ConsumeBool() ? H5S_SCALAR : H5S_NULL), H5Sclose};
  return {H5Screate_simple(rank, dims, nullptr), H5Sclose};
}

std::vector<char> any_values(FuzzedDataProvider& data, std::size_t bytes) {
  std::vector<char> values = data.ConsumeBytes<char>(bytes);
  values.resize(bytes);
  return values;
}

/// A dataset replaced by one of more points than the file has bytes: what is not written takes no room in it.
void claim_much(hid_t file, const std::string& name, FuzzedDataProvider& data) {
  const hsize_t rows = hsize_t{1} << data.ConsumeIntegralInRange(20, 62);
  const hdf5::Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
  const hdf5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const hsize_t chunk = 1024;
  H5Pset_chunk(creation.id(), 1, &chunk);
  const hdf5::Handle dataset(
      H5Dcreate2(file, name.c_str(), H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Dclose);
}

void edit(hid_t file, const Bench& bench, FuzzedDataProvider& data) {
  if (data.ConsumeIntegralInRange(0, 9) == 0) { // an attribute of the file
    static const char* const attributes[] = {"content", "format_version", "version", "isa", "program", "time"};
    const char* name = attributes[data.ConsumeIntegralInRange<std::size_t>(0, std::size(attributes) - 1)];
    H5Adelete(file, name);
    if (data.ConsumeBool()) return;
    bool variable = false;
    hsize_t points = 0;
    const hdf5::Handle type = any_type(data, variable), space = any_space(data, points);
    const hdf5::Handle attribute(H5Acreate2(file, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (attribute && !variable && H5Tget_size(type.id()) > 0)
      H5Awrite(attribute.id(), type.id(), any_values(data, points * H5Tget_size(type.id()) + 1).data());
    return;
  }
  const std::string& name = bench.names[data.ConsumeIntegralInRange<std::size_t>(0, bench.names.size() - 1)];
  const int how = data.ConsumeIntegralInRange(0, 12);
  const hdf5::Handle old(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (old && how < 8) { // other values of the same kind
    const hdf5::Handle type(H5Dget_type(old.id()), H5Tclose), space(H5Dget_space(old.id()), H5Sclose);
    const hssize_t points = H5Sget_simple_extent_npoints(space.id());
    if (points > 0 && points < 10000 && H5Tis_variable_str(type.id()) == 0)
      H5Dwrite(old.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
               any_values(data, static_cast<std::size_t>(points) * H5Tget_size(type.id())).data());
    return;
  }
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  if (how == 8) return;
  if (how == 9) return claim_much(file, name, data);
  bool variable = false;
  hsize_t points = 0;
  const hdf5::Handle type = any_type(data, variable), space = any_space(data, points);
  const hdf5::Handle dataset(
      H5Dcreate2(file, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (!dataset || variable) return;
  H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
           any_values(data, points * H5Tget_size(type.id()) + 1).data());
}

/// What `grandamp resume` does with a file, but for the steps.
void read(const Bench& bench) {
  Checkpoint checkpoint;
  try {
    checkpoint = read_checkpoint(bench.file);
  } catch (const FileError& error) { // and nothing else
    demand_message(error.what());
    return;
  }
  try {
    check_state(checkpoint.state, bench.plan);
    VerletList list;
    restore(list, checkpoint.state.list, static_cast<std::uint32_t>(bench.plan.granules), 6);
    for (const Segment& segment : list.segments())
      for (const PairList* pairs : {&segment.inner, &segment.boundary})
        for (std::size_t k = 0; k < pairs->count(); ++k)
          demand(pairs->data()[k].first() <= 3 && pairs->data()[k].second() <= 3,
                 "pairs are of granules or their two ghosts");
  } catch (const StateError& error) {
    demand_message(error.what());
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const Bench bench;
  static const hdf5::Silence silence;
  if (size == 0) return 0;
  FuzzedDataProvider data(bytes + 1, size - 1);
  switch (bytes[0] % 3) {
  case 0:
    put(bench.file, std::string(reinterpret_cast<const char*>(bytes + 1), size - 1));
    read(bench);
    break;
  case 1: {
    std::string content = bench.good;
    for (int k = 0; k < 4 && data.remaining_bytes() > 0; ++k)
      content[data.ConsumeIntegralInRange<std::size_t>(0, content.size() - 1)] = data.ConsumeIntegral<char>();
    if (data.ConsumeBool()) content.resize(data.ConsumeIntegralInRange<std::size_t>(0, content.size()));
    put(bench.file, content);
    const bool whole = hdf5::check_seal(bench.file).state == hdf5::SealReport::State::whole;
    demand(whole == (content == bench.good), "the seal tells every change");
    if (!whole) read(bench);
    break;
  }
  default: {
    put(bench.file, bench.good);
    {
      const hdf5::Handle file(H5Fopen(bench.file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
      demand(static_cast<bool>(file), "the good file opens");
      for (int k = 0; k < 4 && (k == 0 || data.remaining_bytes() > 0); ++k) edit(file.id(), bench, data);
    }
    const int file = ::open(bench.file.c_str(), O_RDWR | O_CLOEXEC);
    demand(file >= 0 && hdf5::write_seal(file), "the file is sealed");
    ::close(file);
    read(bench);
  }
  }
  return 0;
}
