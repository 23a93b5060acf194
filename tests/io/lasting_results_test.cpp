// Results that survive: kills, cuts, damage, full disks; and readers of them while the run goes on.
#include "io/hdf5_seal.hpp"
#include "io/inspect.hpp"
#include "io/results.hpp"
#include "solver/errors.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <csignal>
#include <cstring>
#include <random>
#include <unistd.h>

using namespace grandamp;
using namespace grandamp::test;

namespace {

Sample row_number(int row) {
  Sample sample;
  const double x = std::sqrt(2.0 + row);
  sample.time = 1e-4 * row;
  sample.displacement = std::sin(x);
  sample.reaction = x / 7.0;
  sample.contacts = row % 17;
  sample.ledger.friction_wall = x;
  sample.stored.structure = 1.0 / x;
  return sample;
}

GranuleTable granules_number(int k) {
  GranuleTable table;
  for (int i = 0; i < 5; ++i) {
    const double x = std::sqrt(3.0 + 10.0 * k + i);
    table.position.push_back({x, x / 3.0, x / 7.0});
    table.velocity.push_back({-x, 1.0 / x, 0.5});
    table.spin.push_back({x, -x, 1e-300});
    table.radius.push_back(1e-3 * (1 + i));
    table.population.push_back(i % 2);
    table.contacts.push_back((k + i) % 4);
  }
  return table;
}

/// What a run of 4000 rows with a snapshot every 500 would record of these rows.
void record(ResultsWriter& writer, int first, int last) {
  for (int row = first; row < last; ++row) {
    if (row % 500 == 0) writer.append_snapshot(granules_number(row / 500), 1e-4 * row);
    writer.append(row_number(row));
  }
}

constexpr int all_rows = 4000;
const std::string scene = "title = \"kept\"\n";

std::filesystem::path in(const TemporaryFolder& folder) {
  return folder / "results.h5";
}

/// Every data set of a file as text: what h5dump prints but for the file's name.
std::string dump(const TemporaryFolder& folder, const std::string& arguments) {
  const Outcome outcome = shell(folder, "h5dump -m %.17g " + arguments + " results.h5");
  REQUIRE(outcome.status == 0);
  return outcome.output;
}

void finish(ResultsWriter& writer) {
  writer.write_final(granules_number(99), 1e-4 * all_rows);
  writer.close();
}

std::string uninterrupted() {
  const TemporaryFolder folder;
  ResultsWriter writer(in(folder), scene, true);
  record(writer, 0, all_rows);
  finish(writer);
  return dump(folder, "");
}

std::vector<std::string> files_in(const TemporaryFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (!entry.path().filename().string().starts_with("shell.")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace

TEST_CASE("cut back and gone on with: the same contents as without a stop, and nothing left over") {
  const std::string expected = uninterrupted();
  for (const bool folded : {false, true}) {
    for (const int kept : {0, 1, 777, 1500, 2501}) {
      CAPTURE(folded);
      CAPTURE(kept);
      const TemporaryFolder folder;
      ResultsPosition position;
      {
        ResultsWriter writer(in(folder), scene, true);
        record(writer, 0, kept);
        writer.sync();
        position = writer.position();
        CHECK(position.rows == kept);
        CHECK(position.snapshots == (kept + 499) / 500);
        record(writer, kept, 3100);
        if (folded) writer.fold();
      } // as a kill leaves it
      ResultsWriter writer = ResultsWriter::go_on(in(folder), scene, true, position);
      CHECK(writer.position().rows == position.rows);
      CHECK(writer.position().snapshots == position.snapshots);
      CHECK(read_history(in(folder)).columns.front().size() == static_cast<std::size_t>(kept)); // cut there too
      record(writer, kept, all_rows);
      finish(writer);
      CHECK(dump(folder, "") == expected);
      CHECK(files_in(folder) == std::vector<std::string>{"results.h5", "snapshots.xdmf"});
    }
  }
}

TEST_CASE("a run that was closed can be gone on with") {
  const std::string expected = uninterrupted();
  const TemporaryFolder folder;
  ResultsPosition position;
  {
    ResultsWriter writer(in(folder), scene, true);
    record(writer, 0, 1800);
    position = writer.position();
    record(writer, 1800, 2000);
    writer.write_final(granules_number(4), 0.2);
    writer.close();
  }
  ResultsWriter writer = ResultsWriter::go_on(in(folder), scene, true, position);
  CHECK_THROWS_AS(read_final_granules(in(folder)), FileError); // of an end that is none any more
  record(writer, 1800, all_rows);
  finish(writer);
  CHECK(dump(folder, "") == expected);
}

TEST_CASE("records that a power cut spoiled are dropped, and fewer than a checkpoint needs is told") {
  const TemporaryFolder folder;
  ResultsPosition position;
  {
    ResultsWriter writer(in(folder), scene, true);
    record(writer, 0, 1000);
    writer.sync();
    position = writer.position();
    record(writer, 1000, 1400);
    writer.sync();
  }
  std::string log = content_of(folder / "history.part");
  const std::size_t record_bytes = 17 * sizeof(double); // 16 columns and a digest
  REQUIRE(log.size() == 64 + 1400 * record_bytes);
  log[64 + 1200 * record_bytes + 5] ^= 1;
  std::memset(log.data() + 64 + 1300 * record_bytes, 0, 100 * record_bytes);
  write_content(folder / "history.part", log);
  CHECK(read_history(in(folder)).columns.front().size() == 1200);
  ResultsWriter::go_on(in(folder), scene, true, position);

  log[64 + 999 * record_bytes] ^= 1;
  write_content(folder / "history.part", log);
  CHECK_THROWS_WITH_AS(ResultsWriter::go_on(in(folder), scene, true, position),
                       doctest::Contains("history.part: holds 999 whole rows; to go on takes 1000"), FileError);
  CHECK_THROWS_WITH_AS(ResultsWriter::go_on(in(folder), scene, false, position),
                       doctest::Contains("is no log of this run's history"), FileError);
}

TEST_CASE("killed at 40 random moments, most of them while it is written: results.h5 is whole, and the run goes on") {
  const std::string expected = uninterrupted();
  std::mt19937 random(7);
  const TemporaryFolder folder;
  ResultsWriter(in(folder), scene, true).sync();
  // The position of the last sync, as a checkpoint would have it.
  const auto remembered = [&] {
    ResultsPosition position;
    const std::string text = std::filesystem::exists(folder / "position") ? content_of(folder / "position") : "0 0";
    std::sscanf(text.c_str(), "%ld %ld", &position.rows, &position.snapshots);
    return position;
  };
  int kills = 0, folding = 0;
  while (kills < 40) {
    const pid_t child = fork();
    if (child == 0) {
      ResultsWriter writer = ResultsWriter::go_on(in(folder), scene, true, remembered());
      for (auto row = static_cast<int>(writer.position().rows); row < all_rows; row += 20) {
        record(writer, row, row + 20);
        writer.sync();
        const ResultsPosition position = writer.position();
        write_content(folder / "position.new",
                      std::to_string(position.rows) + " " + std::to_string(position.snapshots));
        std::filesystem::rename(folder / "position.new", folder / "position");
        writer.fold();
      }
      pause();
    }
    usleep(static_cast<useconds_t>(random() % 60000));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    ++kills;
    folding += std::filesystem::exists(folder / "results.h5.new") ? 1 : 0;
    CHECK(hdf5::check_seal(in(folder)).state == hdf5::SealReport::State::whole);
    CHECK(read_history(in(folder)).columns.front().size() >= static_cast<std::size_t>(remembered().rows));
  }
  MESSAGE("of 40 kills " << folding << " hit a fold");
  CHECK(folding > 5);
  ResultsWriter writer = ResultsWriter::go_on(in(folder), scene, true, remembered());
  record(writer, static_cast<int>(remembered().rows), all_rows);
  finish(writer);
  CHECK(dump(folder, "") == expected);
  std::filesystem::remove(folder / "position");
  std::filesystem::remove(folder / "position.new");
  CHECK(files_in(folder) == std::vector<std::string>{"results.h5", "snapshots.xdmf"});
}

TEST_CASE("h5py opens results.h5 again and again while the program runs, and after it was killed") {
  const TemporaryFolder folder;
  write_content(folder / "small.toml", small_scene());
  write_content(folder / "read.py", R"(
import os, sys, time
import h5py
pid, opened, rows, changes = int(sys.argv[1]), 0, 0, 0
end = time.time() + 120
def look():
    global opened, rows, changes
    with h5py.File("run/results.h5", "r") as f:
        lengths = {d.shape[0] for d in f["/history"].values()}
        assert len(lengths) == 1, lengths
        now = lengths.pop()
        assert now >= rows
        if "snapshots" in f:
            snapshots = f["/snapshots/time"].shape[0]
            assert f["/snapshots/%06d/position" % (snapshots - 1)].shape == (8, 3)
        changes += now > rows
        rows = now
        opened += 1
while time.time() < end and changes < 2:
    look()
os.kill(pid, 9)
for k in range(20):
    look()
print("opened", opened, "rows", rows, "changes", changes)
assert opened > 50 and changes >= 2
)");
  const Outcome outcome =
      shell(folder, std::string(GRANDAMP_PROGRAM) +
                        " run small.toml -o run --threads 1 --quiet --set time.duration=1e4 --set output.window=[0,1]"
                        " --set output.history_interval=1e-2 --set output.snapshot_interval=1 & run=$!\n"
                        "for i in $(seq 200); do [ -e run/results.h5 ] && break; sleep 0.05; done\n"
                        "/usr/bin/python3 read.py $run; status=$?; wait $run; exit $status");
  INFO(outcome.errors);
  CHECK(outcome.status == 0);
  MESSAGE(outcome.output);
  CHECK(program(folder, "inspect run/results.h5").status == 0);
  // What was recorded after the last fold is not lost either.
  REQUIRE(program(folder, "export run history -o history.csv").status == 0);
  const std::size_t folded = std::stoul(outcome.output.substr(outcome.output.find("rows ") + 5));
  CHECK(lines_of(content_of(folder / "history.csv")).size() >= folded + 1);
}

TEST_CASE("a folder that is taken away is told, with its path") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "run");
  ResultsWriter writer(folder / "run/results.h5", scene, true);
  record(writer, 0, 10);
  std::filesystem::remove_all(folder / "run");
  CHECK_THROWS_WITH_AS(writer.sync(), doctest::Contains("run/history.part: cannot find the file: No such file"),
                       FileError);
  CHECK_THROWS_WITH_AS(writer.fold(), doctest::Contains("run/results.h5: cannot create the file: No such file"),
                       FileError);
  CHECK_THROWS_AS(writer.close(), FileError);
}

TEST_CASE("inspect on whole, cut and flipped files: never whole when it is not, never a crash") {
  const TemporaryFolder folder;
  {
    ResultsWriter writer(in(folder), scene, true);
    record(writer, 0, 1700);
    finish(writer);
  }
  const Inspection good = inspect(in(folder));
  CHECK(good.whole);
  for (const char* part : {"whole", "format_version: 2", "time reached: 0.1699", "1700 rows", "/history/reaction",
                           "float64", "[1700]", "/snapshots/000000 : time = 0", "[5 x 3]", "m/s", "/final"})
    CHECK_MESSAGE(contains(good.text, part), part);
  const Outcome told = program(folder, "inspect results.h5");
  CHECK(told.status == 0);
  CHECK(contains(told.output, "/history/reaction"));

  const std::string whole = content_of(in(folder));
  const std::filesystem::path damaged = folder / "damaged.h5";
  for (std::size_t cut = 0; cut < whole.size(); cut += 16384) {
    write_content(damaged, whole.substr(0, cut));
    const Inspection found = inspect(damaged);
    CHECK_FALSE(found.whole);
    CHECK(contains(found.text, "damaged: the file is "));
    CHECK_THROWS_AS(read_history(damaged), FileError);
  }
  std::mt19937_64 random(11);
  for (int k = 0; k < 200; ++k) {
    std::string content = whole;
    const std::size_t at = k < 40 ? random() % hdf5::seal_bytes : random() % whole.size();
    content[at] = static_cast<char>(content[at] ^ (1 << (random() % 8)));
    write_content(damaged, content);
    const hdf5::SealReport seal = hdf5::check_seal(damaged);
    REQUIRE(seal.state == hdf5::SealReport::State::damaged);
    CHECK_THROWS_WITH_AS(read_history(damaged), doctest::Contains("is damaged: "), FileError);
    if (k % 5 == 0) CHECK_FALSE(inspect(damaged).whole);
  }
  write_content(damaged, whole + "more");
  CHECK(contains(inspect(damaged).text, "4 bytes after its end"));
  const Outcome refused = program(folder, "inspect damaged.h5");
  CHECK(refused.status == 4);
  write_content(folder / "rubbish.h5", "no HDF5 at all");
  CHECK(program(folder, "inspect rubbish.h5").status == 4);
  CHECK(program(folder, "inspect absent.h5").status == 4);
}
