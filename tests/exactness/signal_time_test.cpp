// A signal is heard soon, however many granules there are and whatever is done with them. Seconds are printed; what is
// demanded leaves room for a machine that does other things too.
#include "io/checkpoint.hpp"
#include "tests/exactness/exactness_support.hpp"
#include "tests/support/process.hpp"
#include "tests/support/runs.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

using namespace grandamp;
using namespace grandamp::test;

namespace {

std::string many(std::size_t granules, double fill, const std::string& packing) {
  const double side = std::cbrt(static_cast<double>(granules) * 4.0 / 3.0 * 3.14159265 * 1e-9 / fill);
  return fmt::format(R"(gravity = [0.0, 0.0, -9.81]
[enclosure]
shape = "box"
size = [{0}, {0}, {0}]
[[granules]]
name = "acrylic"
count = {1}
radius = 1.0e-3
density = 1190.0
[packing]
kind = "{2}"
[contact.granule]
stiffness = 1.0e7
reference_radius = 3.0e-3
restitution = 0.89
friction = 0.52
[time]
duration = 1.0
impact_speed = 2.0
[output]
snapshot_interval = 1.0e-2
checkpoint_interval = 2.0
)",
                     side, granules, packing);
}

struct Stop {
  double seconds = 0.0; ///< from the signal to the end
  int status = -1;
  std::string messages;
};

/// The run is stopped once `sign` is there, or after a second.
Stop stopped_at(const TemporaryFolder& folder, const std::string& scene, const std::string& sign) {
  write_content(folder / "many.toml", scene);
  std::filesystem::remove(folder / "messages");
  Process process({"run", (folder / "many.toml").string(), "-o", (folder / "run").string(), "--force"},
                  folder / "messages");
  if (sign.empty()) wait_for(1.0);
  for (int k = 0; !sign.empty() && k < 30000 && !std::filesystem::exists(folder / sign); ++k) wait_for(0.01);
  const double before = process.seconds();
  process.send(SIGTERM);
  Stop stop;
  stop.status = process.wait();
  stop.seconds = process.seconds() - before;
  stop.messages = content_of(folder / "messages");
  return stop;
}

constexpr double soon = 10.0; // s

} // namespace

TEST_CASE("a signal is heard soon with many granules: while places are sought and while they pour and in the run") {
  const std::size_t granules = full_tests() ? 1000000 : 60000;
  const TemporaryFolder folder;
  Stop stop = stopped_at(folder, many(granules, 0.6, "random"), "");
  MESSAGE(granules << " granules, places sought: " << stop.seconds << " s");
  INFO(stop.messages);
  CHECK(stop.status == 130);
  CHECK(contains(stop.messages, "while places for the granules were sought"));
  CHECK(stop.seconds < soon);
  CHECK_FALSE(std::filesystem::exists(folder / "run"));

  stop = stopped_at(folder, many(granules, 0.3, "settled"), "run/checkpoint.h5");
  MESSAGE(granules << " granules, pouring: " << stop.seconds << " s, checkpoint and all");
  CHECK(stop.status == 130);
  CHECK(stop.seconds < soon);
  CHECK(find_checkpoint(CheckpointFiles(folder / "run")).checkpoint.recording.pouring);

  std::filesystem::remove_all(folder / "run");
  stop = stopped_at(folder, many(granules, 0.1, "random"), "run/results.h5");
  MESSAGE(granules << " granules, running: " << stop.seconds << " s, checkpoint, results and all");
  CHECK(stop.status == 130);
  CHECK(stop.seconds < soon);
  CHECK(find_checkpoint(CheckpointFiles(folder / "run")).checkpoint.state.id.size() == granules);
}
