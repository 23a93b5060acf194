// The decay of a free vibration as a table and a picture, and its way through summary.json.
#include "io/decay_files.hpp"
#include "io/run.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace grandamp;
using namespace grandamp::test;

namespace {

std::string message_of(const TemporaryFolder& folder, const std::string& summary) {
  write_content(folder / "summary.json", summary);
  try {
    read_cycles(folder / "summary.json");
  } catch (const UsageError& error) {
    return std::string("usage: ") + error.what();
  } catch (const FileError& error) {
    return std::string("file: ") + error.what();
  }
  return {};
}

} // namespace

TEST_CASE("cycles come back from a summary and stand in the table, a row each") {
  const TemporaryFolder folder;
  write_content(folder / "summary.json",
                R"({"structure": {"cycles": [
                  {"start": 0.0, "amplitude": 0.01, "peak_kinetic_energy": 0.05,
                   "specific_damping_capacity": 0.1, "damping_ratio": 0.0083841},
                  {"start": 0.0628, "amplitude": 0.0095, "peak_kinetic_energy": 0.045,
                   "specific_damping_capacity": null, "damping_ratio": 0.1}]}})");
  const auto cycles = read_cycles(folder / "summary.json");
  REQUIRE(cycles.size() == 2);
  CHECK(cycles[0].damping_ratio == 0.0083841);
  CHECK(std::isnan(cycles[1].specific_damping_capacity));
  const auto lines = lines_of(decay_csv(cycles));
  REQUIRE(lines.size() == 3);
  CHECK(lines[0] == "cycle,start,amplitude,peak_kinetic_energy,specific_damping_capacity,damping_ratio");
  CHECK(lines[1] == "1,0,0.01,0.050000000000000003,0.10000000000000001,0.0083841000000000002");
  CHECK(lines[2].find("2,0.062799999999999995,") == 0);
  const std::string picture = decay_svg(cycles, "let go", {.mass = 0.1, .stiffness = 1000.0, .damping = 0.2});
  CHECK(contains(picture, "let go"));
  CHECK(contains(picture, "the structure&#39;s own"));
}

TEST_CASE("a summary without cycles is refused with the reason, a damaged one as a file") {
  const TemporaryFolder folder;
  CHECK(contains(message_of(folder, R"({"structure": {"amplitude": 1.0}})"), "usage: no decay: the run is no free"));
  CHECK(contains(message_of(folder, R"({"title": "a box"})"), "usage: no decay"));
  CHECK(contains(message_of(folder, R"({"structure": {"cycles": []}})"), "usage: no decay: the run holds no whole"));
  CHECK(contains(message_of(folder, R"({"structure": {"cycles": [{"start": 1.0}]}})"), "file: "));
  CHECK(contains(message_of(folder, R"({"structure": {"cycles": [3]}})"), "file: "));
  CHECK(contains(message_of(folder, R"({"structure": {"cycles": 3}})"), "file: "));
  CHECK(contains(message_of(folder, R"({"structure": {"cycles": [{"start": "x"}]}})"), "file: "));
  CHECK(contains(message_of(folder, "[1, 2"), "file: "));
  CHECK_THROWS_AS(read_cycles(folder / "nowhere.json"), FileError);
}
