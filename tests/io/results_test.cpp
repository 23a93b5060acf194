// results.h5 and its exports, through the library and as other programs read them.
#include "io/hdf5.hpp"
#include "io/results.hpp"
#include "solver/errors.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// Numbers that no rounding in between would survive.
Sample sample_number(int row) {
  Sample sample;
  const double x = std::sqrt(2.0 + row);
  sample.time = 1e-4 * row;
  sample.displacement = 1e-3 * std::sin(x);
  sample.velocity = std::cos(x);
  sample.excitation = x / 3.0;
  sample.reaction = -x / 7.0;
  sample.stored = {1e-5 / x, 2e-5 / x, 3e-5 / x, 4e-5 / x};
  sample.contacts = row % 17;
  sample.ledger = {x / 11.0, x / 13.0, x / 17.0, x / 19.0, x / 23.0, x / 29.0};
  return sample;
}

GranuleTable three_granules() {
  GranuleTable table;
  for (int i = 0; i < 3; ++i) {
    const double x = std::sqrt(5.0 + i);
    table.position.push_back({x / 3.0, x / 7.0, x / 11.0});
    table.velocity.push_back({-x, x / 13.0, 0.0});
    table.spin.push_back({1e3 / x, -x, 1e-300});
    table.radius.push_back(1e-3 / x);
    table.population.push_back(i % 2);
    table.contacts.push_back(3 - i);
  }
  return table;
}

const std::string scene_text = "title = \"\xC3\xA4 scene\"\n";

std::filesystem::path written(const TemporaryFolder& folder, int rows, bool ledger) {
  ResultsWriter writer(folder / "results.h5", scene_text, ledger);
  for (int row = 0; row < rows; ++row) {
    writer.append(sample_number(row));
    if (row == 1500) writer.fold();
  }
  writer.write_final(three_granules(), 0.125);
  writer.close();
  return folder / "results.h5";
}

} // namespace

TEST_CASE("histories come back bit for bit, over several blocks") {
  const TemporaryFolder folder;
  const History history = read_history(written(folder, 3333, true));
  const std::vector<std::string> names{
      "time",        "displacement",     "velocity",      "excitation", "reaction",           "kinetic",
      "elastic",     "gravitational",    "contacts",      "work_in",    "structural_damping", "normal_granule",
      "normal_wall", "friction_granule", "friction_wall", "structure"};
  REQUIRE(history.names == names);
  for (const auto& column : history.columns) REQUIRE(column.size() == 3333);
  bool same = true;
  for (int row = 0; row < 3333; ++row) {
    const auto at = static_cast<std::size_t>(row);
    const Sample sample = sample_number(row);
    same = same && history.columns[0][at] == sample.time && history.columns[1][at] == sample.displacement &&
           history.columns[4][at] == sample.reaction && history.columns[6][at] == sample.stored.elastic &&
           history.columns[7][at] == sample.stored.gravitational &&
           history.columns[8][at] == static_cast<double>(sample.contacts) &&
           history.columns[9][at] == sample.ledger.work_in && history.columns[15][at] == sample.stored.structure;
  }
  CHECK(same);
  CHECK(read_stored_scene(folder / "results.h5") == scene_text);
}

TEST_CASE("without the ledger its columns are not there") {
  const TemporaryFolder folder;
  const History history = read_history(written(folder, 1, false));
  CHECK(history.names.size() == 9);
  CHECK(history.names.back() == "contacts");
}

TEST_CASE("granules come back bit for bit, and so do none") {
  const TemporaryFolder folder;
  const Snapshot granules = read_final_granules(written(folder, 1, true));
  const GranuleTable expected = three_granules();
  CHECK(granules.time == 0.125);
  CHECK(granules.table.position == expected.position);
  CHECK(granules.table.velocity == expected.velocity);
  CHECK(granules.table.spin == expected.spin);
  CHECK(granules.table.radius == expected.radius);
  CHECK(granules.table.population == expected.population);
  CHECK(granules.table.contacts == expected.contacts);

  ResultsWriter writer(folder / "none.h5", "", true);
  writer.write_final({}, 1.0);
  writer.close();
  CHECK(read_final_granules(folder / "none.h5").table.position.empty());
  CHECK(read_stored_scene(folder / "none.h5").empty());
  CHECK(read_history(folder / "none.h5").columns.front().empty());
}

TEST_CASE("a file that was folded can be read though the run goes on") {
  const TemporaryFolder folder;
  ResultsWriter writer(folder / "results.h5", scene_text, false);
  for (int row = 0; row < 10; ++row) writer.append(sample_number(row));
  writer.fold();
  std::filesystem::copy_file(folder / "results.h5", folder / "copy.h5"); // as a run that was killed leaves it
  CHECK(read_history(folder / "copy.h5").columns.front().size() == 10);
  CHECK_THROWS_WITH_AS(read_final_granules(folder / "copy.h5"), doctest::Contains("stopped before"), FileError);
}

TEST_CASE("exports have 17 significant digits and the contract's headers") {
  const TemporaryFolder folder;
  export_granules(three_granules(), folder / "granules.csv");
  const auto granules = lines_of(content_of(folder / "granules.csv"));
  REQUIRE(granules.size() == 4);
  CHECK(granules[0] == "id,x,y,z,radius,vx,vy,vz,wx,wy,wz");
  CHECK(granules[1].starts_with("0,"));
  CHECK(granules[3].starts_with("2,"));

  const History history = read_history(written(folder, 50, false));
  export_history(history, folder / "history.csv");
  const auto rows = lines_of(content_of(folder / "history.csv"));
  REQUIRE(rows.size() == 51);
  CHECK(rows[0] == "time,displacement,velocity,excitation,reaction,kinetic,elastic,gravitational,contacts");
  const char* text = rows[50].c_str();
  for (const auto& column : history.columns) {
    char* end = nullptr;
    CHECK(std::strtod(text, &end) == column[49]);
    text = end + 1;
  }
}

TEST_CASE("what is wrong with a file is told with its name and the reason") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(ResultsWriter(folder / "no/results.h5", "", true), doctest::Contains("No such file"), FileError);
  CHECK_THROWS_WITH_AS(read_history(folder / "absent.h5"), doctest::Contains("absent.h5"), FileError);
  write_content(folder / "rubbish.h5", "this is no HDF5 file");
  CHECK_THROWS_WITH_AS(read_history(folder / "rubbish.h5"), doctest::Contains("rubbish.h5"), FileError);
  const std::string whole = content_of(written(folder, 2000, true));
  write_content(folder / "cut.h5", whole.substr(0, whole.size() / 2));
  CHECK_THROWS_AS(read_history(folder / "cut.h5"), FileError);
  CHECK_THROWS_WITH_AS(export_granules({}, folder / "no/granules.csv"), doctest::Contains("No such file"), FileError);
  CHECK_THROWS_WITH_AS(export_granules(three_granules(), "/dev/full"), doctest::Contains("No space left"), FileError);
}

TEST_CASE("a disk that is full costs what came after it was full, and no more") {
  const TemporaryFolder folder;
  ResultsWriter writer(folder / "results.h5", scene_text, false);
  writer.append(sample_number(0));
  writer.fold();
  struct rlimit old {};
  getrlimit(RLIMIT_FSIZE, &old);
  const struct rlimit small { 20000, old.rlim_max };
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const auto record_and_close = [&writer] {
    for (int row = 1; row < 5000; ++row) writer.append(sample_number(row));
    writer.close();
  };
  CHECK_THROWS_WITH_AS(record_and_close(), doctest::Contains("File too large"), FileError);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  // The file is as after the last fold; of the rest, what the log had room for is not lost.
  CHECK(hdf5::File::open(folder / "results.h5").read_doubles("/history/time").size() == 1);
  CHECK(read_history(folder / "results.h5").columns.front().size() > 100);
}

TEST_CASE("h5py and h5dump read the file") {
  const TemporaryFolder folder;
  written(folder, 2000, true);
  write_content(folder / "read.py", R"(
import h5py
with h5py.File("results.h5") as f:
    print(f.attrs["program"].decode(), int(f.attrs["format_version"]), f["/scene"][()].decode().strip())
    print(list(f["/history"]), f["/history/time"].shape, repr(float(f["/history/time"][1999])))
    print(f["/history/kinetic"].attrs["units"].decode(), "/", f["/history/kinetic"].attrs["description"].decode())
    print(f["/final/position"].shape, float(f["/final"].attrs["time"]), list(f["/final/id"]))
)");
  // Debian's own Python has Debian's h5py, whatever else comes first on the path.
  const Outcome python = shell(folder, "/usr/bin/python3 read.py");
  INFO(python.errors);
  REQUIRE(python.status == 0);
  CHECK(contains(python.output, "grandamp 2 title = \"\xC3\xA4 scene\""));
  CHECK(contains(python.output, "(2000,) 0.1999"));
  CHECK(contains(python.output, "J / of the granules"));
  CHECK(contains(python.output, "(3, 3) 0.125 [0, 1, 2]"));
  const Outcome dump = shell(folder, "h5dump -H results.h5");
  CHECK(dump.status == 0);
  CHECK(contains(dump.output, "H5S_UNLIMITED"));
}
