// Snapshots: when they are taken, what they hold, that they change nothing, and that ParaView shows them.
#include "io/results.hpp"
#include "io/run.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace grandamp;
using namespace grandamp::test;

namespace {

void run_with(const TemporaryFolder& folder, const std::string& name, std::vector<std::string> overrides) {
  RunSceneOptions options;
  options.threads = 1;
  run_scene(read_scene_text(small_scene(), "small.toml", overrides), folder / name, options);
}

double length(const Vector3& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

} // namespace

TEST_CASE("snapshots are at t = 0 and at the steps nearest to the multiples, and change nothing") {
  const TemporaryFolder folder;
  run_with(folder, "without", {});
  run_with(folder, "with", {"output.snapshot_interval=3.3e-3", "time.duration=0.05"});
  const auto with = folder / "with/results.h5", without = folder / "without/results.h5";
  const Snapshot end = read_final_granules(with), expected = read_final_granules(without);
  CHECK(end.table.position == expected.table.position);
  CHECK(end.table.velocity == expected.table.velocity);
  CHECK(end.table.spin == expected.table.spin);
  CHECK(end.table.contacts == expected.table.contacts);
  CHECK(read_history(with).columns == read_history(without).columns);
  CHECK_FALSE(read_snapshot_near(without, 0.01));
  CHECK_FALSE(std::filesystem::exists(folder / "without/snapshots.xdmf"));
  for (int k = 0; k <= 15; ++k) {
    const auto snapshot = read_snapshot_near(with, 3.3e-3 * k + 1e-4);
    REQUIRE(snapshot);
    CHECK(snapshot->time == doctest::Approx(3.3e-3 * k).epsilon(1e-9));
  }
  CHECK(read_snapshot_near(with, 1e9)->time == end.time);
}

TEST_CASE("a snapshot is what the simulation has at that step, contacts included") {
  const TemporaryFolder folder;
  run_with(folder, "run", {"output.snapshot_interval=5e-3", "output.history_interval=5e-3"});
  const History history = read_history(folder / "run/results.h5");
  Simulation simulation(read_scene_text(small_scene(), "small.toml").scene,
                        {.threads = 1, .isa = "", .pouring_progress = {}});
  bool touched = false;
  for (int k = 1; k <= 10; ++k) {
    while (simulation.step_number() < 1000 * k) simulation.step();
    const auto snapshot = read_snapshot_near(folder / "run/results.h5", 5e-3 * k);
    REQUIRE(snapshot);
    const GranuleTable expected = simulation.granules();
    CHECK(snapshot->time == simulation.time());
    CHECK(snapshot->table.position == expected.position);
    CHECK(snapshot->table.velocity == expected.velocity);
    CHECK(snapshot->table.spin == expected.spin);
    CHECK(snapshot->table.contacts == expected.contacts);
    // The row of the same instant counts a contact of two once, of one with a wall once.
    std::int32_t sum = 0, walls = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      sum += snapshot->table.contacts[i];
      const Vector3& p = snapshot->table.position[i];
      const double r = snapshot->table.radius[i];
      const double size[3] = {0.01, 0.01, 0.012};
      for (std::size_t d = 0; d < 3; ++d) walls += (p[d] < r ? 1 : 0) + (size[d] - p[d] < r ? 1 : 0);
    }
    const auto counted = static_cast<std::int32_t>(history.columns[8][static_cast<std::size_t>(k)]);
    CHECK((sum - walls) / 2 + walls == counted);
    touched = touched || counted > 0;
  }
  CHECK(touched);
}

TEST_CASE("export granules --time takes the nearest snapshot, also of a run that was killed") {
  const TemporaryFolder folder;
  run_with(folder, "run", {"output.snapshot_interval=0.01"});
  REQUIRE(program(folder, "export run granules --time 0.0149 -o granules.csv").status == 0);
  const auto rows = lines_of(content_of(folder / "granules.csv"));
  REQUIRE(rows.size() == 9);
  const Snapshot expected = *read_snapshot_near(folder / "run/results.h5", 0.01);
  CHECK(std::stod(rows[1].substr(2)) == expected.table.position[0][0]);

  ResultsWriter writer(folder / "results.h5", "", false);
  writer.append_snapshot(expected.table, 0.5);
  writer.fold();
  writer.append_snapshot(expected.table, 1.0);
  writer.sync(); // beyond the last fold
  CHECK(read_snapshot_near(folder / "results.h5", 0.9)->time == 1.0);
  CHECK(read_snapshot_near(folder / "results.h5", 0.6)->time == 0.5);
}

TEST_CASE("the XDMF file points at data sets that are there, of the shapes it says") {
  const TemporaryFolder folder;
  run_with(folder, "run", {"output.snapshot_interval=0.01"});
  write_content(folder / "check.py", R"(
import xml.etree.ElementTree as tree
import h5py
grids = tree.parse("run/snapshots.xdmf").getroot().findall("./Domain/Grid/Grid")
times, seen = [], set()
with h5py.File("run/results.h5") as f:
    for grid in grids:
        times.append(float(grid.find("Time").get("Value")))
        assert grid.find("Topology").get("NumberOfElements") == "8"
        for attribute in grid.findall("Attribute"):
            seen.add(attribute.get("Name"))
        for item in grid.iter("DataItem"):
            name, path = item.text.split(":")
            assert name == "results.h5"
            data = f[path]
            shape = [int(n) for n in item.get("Dimensions").split()]
            assert data.size == shape[0] * (shape[1] if len(shape) > 1 else 1), (path, shape)
            assert data.dtype.itemsize == int(item.get("Precision"))
            assert data.dtype.kind == {"Float": "f", "Int": "i"}[item.get("NumberType")]
    assert times == list(f["/snapshots/time"])
    speed = f["/snapshots/000003/speed"][:]
    velocity = f["/snapshots/000003/velocity"][:]
    assert abs((velocity ** 2).sum(axis=1) ** 0.5 - speed).max() <= 1e-15 * speed.max()
print(len(times), sorted(seen))
)");
  const Outcome outcome = shell(folder, "/usr/bin/python3 check.py");
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  CHECK(outcome.output == "6 ['contacts', 'population', 'radius', 'speed', 'spin', 'velocity']\n");
}

TEST_CASE("ParaView reads the snapshots as points, with each of its readers") {
  const TemporaryFolder folder;
  if (shell(folder, "command -v pvpython").status != 0) {
    MESSAGE("skipped: there is no pvpython (package paraview)");
    return;
  }
  run_with(folder, "run", {"output.snapshot_interval=0.01"});
  write_content(folder / "show.py", R"(
from paraview import servermanager
from paraview.simple import OpenDataFile, XDMFReader
for reader in (OpenDataFile("run/snapshots.xdmf"), XDMFReader(FileNames=["run/snapshots.xdmf"])):
    reader.UpdatePipelineInformation()
    print(reader.GetXMLName(), list(reader.TimestepValues))
    for time in reader.TimestepValues:
        reader.UpdatePipeline(time)
        points = servermanager.Fetch(reader)
        print("cells", points.GetNumberOfCells())
        data = points.GetPointData()
        for i in range(points.GetNumberOfPoints()):
            values = list(points.GetPoint(i))
            for name in ("radius", "speed", "velocity", "spin", "population", "contacts"):
                values += data.GetArray(name).GetTuple(i)
            print("point", " ".join(repr(float(value)) for value in values))
)");
  const Outcome outcome = shell(folder, "timeout 300 pvpython show.py");
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  const auto lines = lines_of(outcome.output);
  std::size_t line = 0;
  for (const char* reader : {"Xdmf3ReaderS", "XdmfReader"}) {
    REQUIRE(line < lines.size());
    CHECK(lines[line++] == std::string(reader) + " [0.0, 0.01, 0.02, 0.030000000000000002, 0.04, 0.05]");
    for (int k = 0; k <= 5; ++k) {
      const Snapshot snapshot = *read_snapshot_near(folder / "run/results.h5", 0.01 * k);
      REQUIRE(line + 9 <= lines.size());
      CHECK(lines[line++] == "cells 8");
      for (std::size_t i = 0; i < 8; ++i) {
        const GranuleTable& t = snapshot.table;
        std::vector<double> expected(t.position[i].begin(), t.position[i].end());
        expected.insert(expected.end(), {t.radius[i], length(t.velocity[i])});
        expected.insert(expected.end(), t.velocity[i].begin(), t.velocity[i].end());
        expected.insert(expected.end(), t.spin[i].begin(), t.spin[i].end());
        expected.push_back(t.population[i]);
        expected.push_back(t.contacts[i]);
        const char* text = lines[line++].c_str() + 6;
        for (const double value : expected) {
          char* next = nullptr;
          CHECK(std::strtod(text, &next) == doctest::Approx(value).epsilon(1e-12));
          text = next;
        }
      }
    }
  }
}
