// A run seen and told from outside while it goes: signals, wall time, progress, readers, broken streams.
#include "io/checkpoint.hpp"
#include "io/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/process.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scene_texts.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// Eight granules for hours.
std::vector<std::string> endless(const TemporaryFolder& folder, const std::string& run) {
  write_content(folder / "small.toml", small_scene());
  return {"run",
          (folder / "small.toml").string(),
          "-o",
          (folder / run).string(),
          "--quiet",
          "--threads",
          "1",
          "--set",
          "time.duration=1e4",
          "--set",
          "output.history_interval=1e-2"};
}

bool comes(const std::filesystem::path& file) {
  for (int k = 0; k < 3000 && !std::filesystem::exists(file); ++k) wait_for(0.01);
  return std::filesystem::exists(file);
}

std::int64_t steps_of_checkpoint(const std::filesystem::path& folder) {
  return find_checkpoint(CheckpointFiles(folder)).checkpoint.state.step_number;
}

} // namespace

TEST_CASE("SIGUSR1 writes a checkpoint and the run goes on, SIGTERM and SIGHUP end it with one") {
  const TemporaryFolder folder;
  std::int64_t before = 0;
  {
    Process process(endless(folder, "run"), folder / "messages");
    REQUIRE(comes(folder / "run/results.h5"));
    process.send(SIGUSR1);
    REQUIRE(comes(folder / "run/checkpoint.h5"));
    CHECK_FALSE(process.ends_within(0.3));
    CHECK_FALSE(std::filesystem::exists(folder / "run/summary.json"));
    before = steps_of_checkpoint(folder / "run");
    process.send(SIGTERM);
    CHECK(process.ends_within(20.0));
    CHECK(process.wait() == 130);
  }
  const std::int64_t then = steps_of_checkpoint(folder / "run");
  CHECK(then > before);
  CHECK(std::filesystem::exists(folder / "run/checkpoint.previous.h5"));
  Process process({"resume", (folder / "run").string(), "--threads", "1"}, folder / "messages");
  for (int k = 0; k < 3000 && std::filesystem::exists(folder / "run/summary.json"); ++k) wait_for(0.01);
  wait_for(0.3);
  process.send(SIGHUP); // its terminal went away
  CHECK(process.ends_within(20.0));
  CHECK(process.wait() == 130);
  CHECK(steps_of_checkpoint(folder / "run") > then);
  CHECK(contains(content_of(folder / "messages"), "go on with: grandamp resume"));
}

TEST_CASE("nohup: a terminal that goes away is not heard") {
  const TemporaryFolder folder;
  std::signal(SIGHUP, SIG_IGN); // as the program's parent hands it on
  Process process(endless(folder, "run"), folder / "messages");
  std::signal(SIGHUP, SIG_DFL);
  REQUIRE(comes(folder / "run/results.h5"));
  process.send(SIGHUP);
  CHECK_FALSE(process.ends_within(0.5));
}

TEST_CASE("a second SIGINT ends the program at once, whatever it is at") {
  const TemporaryFolder folder;
  setenv("GRANDAMP_TEST_CHECKPOINT_DELAY", "60000", 1);
  Process process(endless(folder, "run"), folder / "messages");
  unsetenv("GRANDAMP_TEST_CHECKPOINT_DELAY");
  REQUIRE(comes(folder / "run/results.h5"));
  process.send(SIGINT);
  REQUIRE(comes(folder / "run/checkpoint.next.h5.new")); // for a minute
  CHECK_FALSE(process.ends_within(0.3));
  process.send(SIGINT);
  CHECK(process.ends_within(10.0));
  CHECK(process.wait() == 130);
}

TEST_CASE("--max-wall ends a part of a run with a checkpoint, while it pours and while it runs") {
  const TemporaryFolder folder;
  write_content(folder / "bed.toml", replaced(replaced(small_scene(), "kind = \"random\"", "kind = \"settled\""),
                                              "duration = 0.05", "duration = 0.3"));
  REQUIRE(program(folder, "run bed.toml -o whole --threads 1 --quiet").status == 0);
  REQUIRE(program(folder, "run bed.toml -o run --threads 1 --quiet --max-wall 0.01").status == 130);
  CHECK(find_checkpoint(CheckpointFiles(folder / "run")).checkpoint.recording.pouring);
  CHECK_FALSE(std::filesystem::exists(folder / "run/results.h5"));
  CHECK(contains(program(folder, "inspect run/checkpoint.h5").output, "/recording/pouring"));
  const Outcome refused = program(folder, "resume run --set granules.0.count=7");
  CHECK(refused.status == 2);
  CHECK(contains(refused.errors, "granules.0.count cannot change"));
  int parts = 1;
  for (int status = 130; status == 130 && parts < 200; ++parts)
    status = program(folder, "resume run --quiet --max-wall " + std::string(parts < 8 ? "0.02" : "0.2")).status;
  CHECK(parts > 4);
  CHECK(read_final_granules(folder / "run/results.h5").table.position ==
        read_final_granules(folder / "whole/results.h5").table.position);
  CHECK(read_history(folder / "run/results.h5").columns == read_history(folder / "whole/results.h5").columns);
}

TEST_CASE("progress: one line that updates on a terminal, none within a minute in a log, and no harm without either") {
  const TemporaryFolder folder;
  write_content(folder / "small.toml", small_scene());
  write_content(folder / "terminal.py", R"(
import os, pty, signal, subprocess, sys, time
def started(name, stderr):
    command = [sys.argv[1], "run", "small.toml", "-o", name, "--threads", "1", "--set", "time.duration=1e3",
               "--set", "output.history_interval=1e-2"]
    return subprocess.Popen(command, stderr=stderr, preexec_fn=os.setpgrp)
master, slave = pty.openpty()
run = started("terminal", slave)
os.close(slave)
text, end = b"", time.time() + 60
while time.time() < end and (text.count(b"\r") < 6 or b"amplitude" not in text):
    text += os.read(master, 4096)
lines = text.decode().split("\r")
shown = [line for line in lines if "granule-steps/s" in line and " left" in line]
assert len(shown) >= 2 and "amplitude" in text.decode(), text
assert all("\n" not in line for line in shown[:-1]), shown
os.close(master) # the terminal goes away: writing to it fails from now on
time.sleep(0.5)
assert run.poll() is None
run.send_signal(signal.SIGTERM)
assert run.wait() == 130, run.returncode
assert os.path.exists("terminal/summary.json")
seconds = float(sys.argv[2])
run = started("log", subprocess.PIPE)
while not os.path.exists("log/results.h5") and run.poll() is None:
    time.sleep(0.01)
time.sleep(seconds)
run.send_signal(signal.SIGTERM)
log = run.communicate()[1].decode()
lines = [line for line in log.split("\n") if "granule-steps/s" in line]
assert "\r" not in log and len(lines) == (1 if seconds > 60 else 0), log
print(lines)
run = started("broken", subprocess.PIPE)
run.stderr.close() # whoever read the messages died
while not os.path.exists("broken/results.h5") and run.poll() is None:
    time.sleep(0.01)
time.sleep(0.3)
run.send_signal(signal.SIGTERM)
assert run.wait() == 130, run.returncode
)");
  const Outcome outcome =
      shell(folder, std::string("/usr/bin/python3 terminal.py ") + GRANDAMP_PROGRAM + (full_tests() ? " 65" : " 0.5"));
  INFO(outcome.errors);
  CHECK(outcome.status == 0);
  MESSAGE(outcome.output);
}

TEST_CASE("a full disk behind standard output is told") {
  const TemporaryFolder folder;
  write_content(folder / "small.toml", small_scene());
  for (const char* command : {"run small.toml -o run --json --threads 1", "check small.toml", "check small.toml --json",
                              "inspect run/results.h5"}) {
    CAPTURE(command);
    const Outcome outcome = shell(folder, std::string(GRANDAMP_PROGRAM) + " " + command + " >/dev/full");
    CHECK(outcome.status == 4);
    CHECK(contains(outcome.errors, "standard output: cannot write: No space left on device"));
  }
}

TEST_CASE("h5dump reads results.h5 while the program runs") {
  const TemporaryFolder folder;
  Process process(endless(folder, "run"), folder / "messages");
  REQUIRE(comes(folder / "run/results.h5"));
  for (int k = 0; k < 5; ++k) {
    const Outcome outcome = shell(folder, "h5dump -d /history/time run/results.h5");
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.output, "H5T_IEEE_F64LE"));
    wait_for(0.1);
  }
  CHECK_FALSE(process.ended());
}

TEST_CASE("the lines of Python in FORMAT.md plot a run") {
  const TemporaryFolder folder;
  write_content(folder / "small.toml", small_scene());
  REQUIRE(program(folder, "run small.toml -o table5 --threads 1 --quiet").status == 0);
  const std::string text = content_of(std::filesystem::path(GRANDAMP_SOURCE_DIR) / "io/FORMAT.md");
  const std::size_t begin = text.find("```python\n");
  REQUIRE(begin != std::string::npos);
  const std::size_t first = begin + 10, last = text.find("```", first);
  write_content(folder / "plot.py", text.substr(first, last - first));
  CHECK(lines_of(text.substr(first, last - first)).size() <= 12);
  const Outcome outcome = shell(folder, "MPLBACKEND=agg MPLCONFIGDIR=. /usr/bin/python3 plot.py");
  INFO(outcome.errors);
  CHECK(outcome.status == 0);
  CHECK(content_of(folder / "history.png").substr(1, 3) == "PNG");
}
