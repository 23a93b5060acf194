// The program as a user runs it, stopped and killed at random moments, from the pouring to the last file: what it
// leaves in the end is what a run that was never cut leaves.
#include "tests/exactness/exactness_support.hpp"
#include "tests/support/process.hpp"
#include "tests/support/runs.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <random>

using namespace grandamp;
using namespace grandamp::test;

namespace {

struct Cuts {
  int wanted = 0;
  int signal = SIGTERM;
  double checkpoint_interval = 60.0; ///< s
  int slow_checkpoints = 0;          ///< ms in each of the moments that a kill may find; 0: as they are
};

/// Table 5's damper on its way to its end, as often as it takes to be cut so many times.
class CutRuns {
public:
  CutRuns(double duration, std::vector<std::string> more) : more_(std::move(more)) {
    more_.push_back("time.duration=" + std::to_string(duration));
    more_.push_back("output.snapshot_interval=" + std::to_string(duration / 7.3));
    Process whole(arguments("run", folder_ / "whole", 1, 60.0), folder_ / "messages");
    REQUIRE(whole.wait() == 0);
    seconds_ = whole.seconds();
    expected_ = outcomes_of(folder_ / "whole");
  }

  void cut(const Cuts& cuts) {
    if (cuts.slow_checkpoints > 0)
      setenv("GRANDAMP_TEST_CHECKPOINT_DELAY", std::to_string(cuts.slow_checkpoints).c_str(), 1);
    int made = 0, runs = 0, anew = 0, writing = 0;
    // Where files take their time, more than a sixth of the cuts must find one half written; chance may want more cuts
    // for that.
    const auto too_few = [&] { return cuts.slow_checkpoints > 0 && writing <= made / 6; };
    for (; made < cuts.wanted || too_few(); ++runs) {
      REQUIRE(runs < 40);
      const std::filesystem::path run = folder_ / ("run" + std::to_string(runs));
      // A part takes a tenth of a second before its first step, and what a kill takes back again.
      double longest = 0.25 + 2.0 * seconds_ / std::max(cuts.wanted, 12);
      for (int part = 0;; ++part) {
        REQUIRE(part < 400);
        const bool there = std::filesystem::exists(run / "scene.toml");
        anew += there || part == 0 ? 0 : 1;
        Process process(arguments(there ? "resume" : "run", run, 1 + part % 2, cuts.checkpoint_interval),
                        folder_ / "messages");
        if (!process.ends_within(std::uniform_real_distribution<double>(0.0, longest)(random_))) {
          process.send(cuts.signal);
          ++made;
        }
        const int status = process.wait();
        longest *= 1.03; // a machine that grew slower since must come to an end too
        INFO(content_of(folder_ / "messages"));
        if (status == 0) break;
        // A signal that comes before the program listens ends it, and takes nothing with it.
        REQUIRE((status == 128 + cuts.signal || (status == 130 && cuts.signal != SIGKILL)));
        const auto left = [&run](const char* name) { return std::filesystem::exists(run / name); };
        writing += left("checkpoint.next.h5.new") || left("checkpoint.next.h5") || left("results.h5.new") ? 1 : 0;
      }
      check_end(run);
    }
    unsetenv("GRANDAMP_TEST_CHECKPOINT_DELAY");
    MESSAGE(made << " cuts in " << runs << " runs of " << seconds_ << " s; " << writing
                 << " of them while a file was written; " << anew << " before there was anything to go on from");
  }

private:
  std::vector<std::string> arguments(const std::string& command, const std::filesystem::path& run, int threads,
                                     double checkpoint_interval) const {
    const std::string interval = "output.checkpoint_interval=" + std::to_string(checkpoint_interval);
    std::vector<std::string> all{command};
    if (command == "run") {
      all.insert(all.end(), {std::string(GRANDAMP_SOURCE_DIR) + "/io/scenes/table5.toml", "-o", run.string()});
      for (const std::string& one : more_) all.insert(all.end(), {"--set", one});
      all.insert(all.end(), {"--set", interval});
    } else {
      all.push_back(run.string());
    }
    all.insert(all.end(), {"--threads", std::to_string(threads), "--quiet"});
    return all;
  }

  void check_end(const std::filesystem::path& run) {
    check_same(outcomes_of(run), expected_);
    const std::filesystem::path ours = run / "results.h5", whole = folder_ / "whole/results.h5";
    for (const double part : {0.1, 0.5, 0.9}) {
      const double time = part * expected_.granules.time;
      check_same_granules(*read_snapshot_near(ours, time), *read_snapshot_near(whole, time));
    }
    std::vector<std::string> files = files_in(run), expected = files_of_a_run;
    std::erase(files, "checkpoint.previous.h5"); // there if there were two
    std::erase(expected, "checkpoint.previous.h5");
    expected.insert(std::find(expected.begin(), expected.end(), "summary.json"), "snapshots.xdmf");
    CHECK(files == expected);
  }

  TemporaryFolder folder_;
  std::vector<std::string> more_;
  Outcomes expected_;
  double seconds_ = 0.0;
  std::mt19937 random_{11};
};

} // namespace

TEST_CASE("Table 5 stopped by SIGTERM at random moments and resumed on 1 and 2 threads in turn: identical to one run") {
  CutRuns(full_tests() ? 2.0 : 0.4, {}).cut({.wanted = full_tests() ? 20 : 8, .signal = SIGTERM});
}

TEST_CASE("Table 5 killed at random moments and resumed: identical to one run and no temporary files left") {
  CutRuns runs(full_tests() ? 2.0 : 0.3, {});
  const int wanted = full_tests() ? 50 : 6;
  runs.cut({.wanted = wanted, .signal = SIGKILL, .checkpoint_interval = 0.03});
  runs.cut({.wanted = wanted, .signal = SIGKILL, .checkpoint_interval = 0.05, .slow_checkpoints = 15});
}

TEST_CASE("springs that remember: stopped and killed at random moments and resumed and identical to one run") {
  CutRuns runs(full_tests() ? 0.5 : 0.1,
               {"contact.friction=\"spring\"", "contact.granule.tangential_stiffness=0.9e7",
                "contact.wall.tangential_stiffness=1.1e7", "contact.wall.tangential_damping=0.02"});
  runs.cut({.wanted = full_tests() ? 20 : 3, .signal = SIGTERM});
  runs.cut({.wanted = full_tests() ? 20 : 3, .signal = SIGKILL, .checkpoint_interval = 0.03});
}
