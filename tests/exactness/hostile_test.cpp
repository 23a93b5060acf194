// What a run meets outside: full disks, folders that cannot be written to or are taken away, cut and flipped files.
// Either the run goes on from what is whole, to the end of a run that never met any of it, or it says why not.
#include "io/checkpoint.hpp"
#include "tests/exactness/exactness_support.hpp"
#include "tests/support/process.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scene_texts.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace grandamp;
using namespace grandamp::test;

namespace {

namespace fs = std::filesystem;

/// Some two megabytes of history.
std::string talkative() {
  return replaced(replaced(small_scene(), "duration = 0.05", "duration = 0.1"), "history_interval = 1.0e-3",
                  "history_interval = 1.0e-5\nsnapshot_interval = 2.0e-4\ncheckpoint_interval = 0.02");
}

/// A small file system of memory in `folder`; none if this process may not mount one.
class SmallDisk {
public:
  SmallDisk(const TemporaryFolder& folder, const std::string& size) : folder_(folder), path_(folder / "disk") {
    fs::create_directory(path_);
    there_ = shell(folder, "mount -t tmpfs -o size=" + size + " tmpfs disk").status == 0;
    if (!there_) MESSAGE("skipped: this process may not mount a file system");
  }
  ~SmallDisk() {
    if (there_) shell(folder_, "umount -l disk");
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  explicit operator bool() const { return there_; }
  void remount(const std::string& options) const {
    REQUIRE(shell(folder_, "mount -o remount," + options + " disk").status == 0);
  }

private:
  const TemporaryFolder& folder_;
  fs::path path_;
  bool there_ = false;
};

/// The run in `run` is brought to its end, from the start if there is nothing to go on from.
void check_goes_on(const TemporaryFolder& folder, const std::string& run, const Outcomes& whole) {
  Outcome outcome = program(folder, "resume " + run + " --threads 1 --quiet");
  INFO(outcome.errors);
  if (!fs::exists(folder / (run + "/scene.toml")))
    outcome = program(folder, "run scene.toml -o " + run + " --threads 1 --quiet --force");
  REQUIRE(outcome.status == 0);
  check_same(outcomes_of(folder / run), whole);
}

/// A run with two checkpoints behind it, and the rest of it before it.
class StoppedRun {
public:
  StoppedRun() {
    const SceneDocument document = read_scene_text(small_scene(), "small.toml");
    run_scene(document, folder_ / "whole", threads(1));
    run_scene(document, folder_ / "run", stopping_after(4000));
    resume_run(folder_ / "run", {}, stopping_after(4000));
    whole = outcomes_of(folder_ / "whole");
    CheckpointFiles files(folder_ / "run");
    newest = content_of(files.newest);
    previous = content_of(files.previous);
  }

  /// The library's reading of two such checkpoints.
  FoundCheckpoint found_with(const std::string& first, const std::string& second) const {
    const fs::path there = folder_ / "read";
    fs::create_directories(there);
    const CheckpointFiles files(there);
    write_content(files.newest, first);
    write_content(files.previous, second);
    return find_checkpoint(files);
  }

  /// What the program makes of the run with them.
  Outcome resumed_with(const std::string& first, const std::string& second) const {
    fs::remove_all(folder_ / "try");
    fs::copy(folder_ / "run", folder_ / "try");
    const CheckpointFiles files(folder_ / "try");
    write_content(files.newest, first);
    write_content(files.previous, second);
    return program(folder_, "resume try --threads 1");
  }
  void check_end() const { check_same(outcomes_of(folder_ / "try"), whole); }

  Outcomes whole;
  std::string newest, previous;

private:
  TemporaryFolder folder_;
};

} // namespace

TEST_CASE("a full disk: status 4 and the file, and once there is room the run goes on as if there always had been") {
  const TemporaryFolder folder;
  write_content(folder / "scene.toml", talkative());
  REQUIRE(program(folder, "run scene.toml -o whole --threads 1 --quiet").status == 0);
  const Outcomes whole = outcomes_of(folder / "whole");
  int full = 0;
  for (const char* size : {"40k", "120k", "300k", "700k", "1500k", "3m", "5m"}) {
    CAPTURE(size);
    fs::remove_all(folder / "disk");
    const SmallDisk disk(folder, size);
    if (!disk) return;
    const Outcome outcome = program(folder, "run scene.toml -o disk/run --threads 1 --quiet");
    INFO(outcome.errors);
    REQUIRE((outcome.status == 0 || outcome.status == 4));
    if (outcome.status == 4) {
      ++full;
      CHECK(contains(outcome.errors, "No space left on device"));
      CHECK(contains(outcome.errors, "disk/run"));
    }
    disk.remount("size=100m");
    if (fs::exists(folder / "disk/run")) check_goes_on(folder, "disk/run", whole);
  }
  CHECK(full >= 5);
}

TEST_CASE("files that may grow no further: status 4 and the file, and later the run goes on") {
  const TemporaryFolder folder;
  write_content(folder / "scene.toml", talkative());
  REQUIRE(program(folder, "run scene.toml -o whole --threads 1 --quiet").status == 0);
  const Outcomes whole = outcomes_of(folder / "whole");
  int stopped = 0;
  for (const int blocks : {1, 12, 60, 100, 150, 400, 1200}) { // of 512 bytes
    CAPTURE(blocks);
    fs::remove_all(folder / "run");
    const Outcome outcome = shell(folder, "ulimit -f " + std::to_string(blocks) + "; " + GRANDAMP_PROGRAM +
                                              " run scene.toml -o run --threads 1 --quiet");
    INFO(outcome.errors);
    CHECK(outcome.status == 4);
    CHECK(contains(outcome.errors, "File too large"));
    ++stopped;
    if (fs::exists(folder / "run")) check_goes_on(folder, "run", whole);
  }
  CHECK(stopped == 7);
}

TEST_CASE("a read-only file system: nothing runs there and everything can be read there") {
  const TemporaryFolder folder;
  write_content(folder / "scene.toml", small_scene());
  const SmallDisk disk(folder, "20m");
  if (!disk) return;
  REQUIRE(program(folder, "run scene.toml -o disk/run --threads 1 --max-wall 1e-3").status == 130);
  disk.remount("ro");
  for (const char* command :
       {"run scene.toml -o disk/other", "run scene.toml -o disk/run --force", "resume disk/run"}) {
    CAPTURE(command);
    const Outcome outcome = program(folder, command);
    CHECK(outcome.status == 4);
    CHECK(contains(outcome.errors, "Read-only file system"));
  }
  CHECK(program(folder, "inspect disk/run/results.h5").status == 0);
  CHECK(program(folder, "inspect disk/run/checkpoint.h5").status == 0);
  CHECK(program(folder, "export disk/run history -o history.csv").status == 0);
  disk.remount("rw");
  CHECK(program(folder, "resume disk/run --threads 1").status == 0);
}

TEST_CASE("a folder removed under a run: status 4 and its path, soon") {
  const TemporaryFolder folder;
  write_content(folder / "scene.toml", small_scene());
  Process process({"run", (folder / "scene.toml").string(), "-o", (folder / "run").string(), "--quiet", "--set",
                   "time.duration=1e4", "--set", "output.history_interval=1e-2", "--set",
                   "output.checkpoint_interval=0.3"},
                  folder / "messages");
  for (int k = 0; k < 1000 && !fs::exists(folder / "run/checkpoint.h5"); ++k) wait_for(0.01);
  std::error_code ignored; // a file may come while the others go
  for (int k = 0; k < 10 && fs::exists(folder / "run"); ++k) fs::remove_all(folder / "run", ignored);
  REQUIRE(process.ends_within(30.0));
  CHECK(process.wait() == 4);
  CHECK(contains(content_of(folder / "messages"), "run"));
  CHECK(contains(content_of(folder / "messages"), "No such file or directory"));
}

TEST_CASE("a checkpoint cut at every 4 KiB: its predecessor is taken, and said so, and the end is the same") {
  const StoppedRun run;
  int cuts = 0;
  for (std::size_t size = 0; size < run.newest.size(); size += 4096, ++cuts) {
    CAPTURE(size);
    const std::string cut = run.newest.substr(0, size);
    const FoundCheckpoint found = run.found_with(cut, run.previous);
    CHECK(found.checkpoint.state.step_number == 4000);
    REQUIRE(found.damaged.size() == 1);
    CHECK(contains(found.damaged.front(), "checkpoint.h5: damaged: the file is "));
    const Outcome outcome = run.resumed_with(cut, run.previous);
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.errors, "going on from checkpoint.previous.h5"));
    run.check_end();
  }
  CHECK(cuts > 5);
  const Outcome outcome = run.resumed_with(run.newest.substr(0, 5000), run.previous.substr(0, 9000));
  CHECK(outcome.status == 4);
  CHECK(contains(outcome.errors, "holds no checkpoint that can be used"));
}

TEST_CASE("single bits flipped at 200 places of a checkpoint: its predecessor is taken, and the end is the same") {
  const StoppedRun run;
  std::mt19937_64 random(5);
  const int through_the_program = full_tests() ? 200 : 12;
  for (int k = 0; k < 200; ++k) {
    const std::size_t at = k < 40 ? random() % 2048 : random() % run.newest.size();
    CAPTURE(at);
    std::string flipped = run.newest;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (random() % 8)));
    const FoundCheckpoint found = run.found_with(flipped, run.previous);
    CHECK(found.checkpoint.state.step_number == 4000);
    CHECK(found.damaged.size() == 1);
    CHECK_THROWS_AS(run.found_with(flipped, flipped), FileError);
    if (k % (200 / through_the_program) != 0) continue;
    const Outcome outcome = run.resumed_with(flipped, run.previous);
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.errors, "checkpoint.h5: damaged: "));
    run.check_end();
  }
}
