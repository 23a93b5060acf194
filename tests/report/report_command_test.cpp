// `grandamp report` as a user meets it.
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

using namespace grandamp::test;

namespace {

void run_small(const TemporaryFolder& folder, const std::string& options = "") {
  write_content(folder / "small.toml", small_scene());
  const Outcome run = program(folder, "run small.toml --threads 1 " + options);
  INFO(run.errors);
  REQUIRE(run.status == 0);
}

} // namespace

TEST_CASE("report: one page, and its pictures beside it") {
  const TemporaryFolder folder;
  run_small(folder, "--set output.snapshot_interval=0.01");
  const Outcome report = program(folder, "report small");
  INFO(report.errors);
  REQUIRE(report.status == 0);
  CHECK(contains(report.errors, "small/report.html"));
  const std::string page = content_of(folder / "small/report.html");
  CHECK(contains(page, "id=\"data-places\""));
  CHECK(contains(page, "id=\"data-histories\""));
  CHECK(contains(content_of(folder / "small/report/granules_picture.svg"), "<circle"));
  CHECK(std::filesystem::exists(folder / "small/report/displacement.svg"));
}

TEST_CASE("report: a run that was killed is told of as not finished, with what its logs hold") {
  const TemporaryFolder folder;
  run_small(folder);
  std::filesystem::remove(folder / "small/summary.json");
  REQUIRE(program(folder, "report small --quiet").status == 0);
  const std::string page = content_of(folder / "small/report.html");
  CHECK(contains(page, "The run is not finished"));
  CHECK(contains(page, "Do not rely on these numbers"));
}

TEST_CASE("report: nothing to tell of, no folder, damaged files") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "empty");
  const Outcome empty = program(folder, "report empty");
  CHECK(empty.status == 2);
  CHECK(contains(empty.errors, "nothing to report on"));
  const Outcome none = program(folder, "report nowhere");
  CHECK(none.status == 4);
  CHECK(contains(none.errors, "nowhere"));

  run_small(folder);
  const std::string whole = content_of(folder / "small/results.h5");
  std::string damaged = whole;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x10);
  write_content(folder / "small/results.h5", damaged);
  const Outcome hurt = program(folder, "report small");
  CHECK(hurt.status == 4);
  CHECK(contains(hurt.errors, "results.h5"));
  CHECK_FALSE(std::filesystem::exists(folder / "small/report.html"));

  write_content(folder / "small/results.h5", whole);
  write_content(folder / "small/summary.json", "{\"title\": ");
  const Outcome summary = program(folder, "report small");
  CHECK(summary.status == 4);
  CHECK(contains(summary.errors, "summary.json"));

  write_content(folder / "empty/study.json", "{\"settings\": 3}");
  CHECK(program(folder, "report empty").status == 4);
  std::filesystem::remove(folder / "empty/study.json");
  write_content(folder / "empty/sweep.json", "{\"vary\": [{}], \"points\": [{}]}");
  const Outcome sweep = program(folder, "report empty");
  CHECK(sweep.status == 4);
  CHECK(contains(sweep.errors, "sweep.json: is damaged"));
}

TEST_CASE("report: a sweep flags points that are not steady, and one that is not complete") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "sweep");
  write_content(folder / "sweep/sweep.json",
                R"({"title": "A sweep", "version": "0", "isa": "avx2", "status": "incomplete",
    "runs": {"planned": 4, "done": 3, "failed": 0}, "vary": [{"key": "granules.0.radius", "values": [0.001, 0.002]}], "keep": "total_mass",
    "seeds": [1, 2], "scene": "title = '<b>'", "points": [
    {"index": 0, "status": "done", "values": {"granules.0.radius": 0.001}, "granules": 10, "done": 2, "steady": false,
     "mean": {"structure.rms_displacement": 0.002}, "error": {"structure.rms_displacement": 0.0001}, "runs": []},
    {"index": 1, "status": "incomplete", "values": {"granules.0.radius": 0.002}, "granules": 5, "done": 1, "steady": true,
     "mean": {"structure.rms_displacement": 0.001}, "error": {"structure.rms_displacement": null}, "runs": []}]})");
  const Outcome report = program(folder, "report sweep");
  INFO(report.errors);
  REQUIRE(report.status == 0);
  const std::string page = content_of(folder / "sweep/report.html");
  CHECK(contains(page, "NOT STEADY"));
  CHECK(contains(page, "1 of 2 points are not steady"));
  CHECK(contains(page, "Not complete"));
  CHECK(contains(page, "2 ± 0.1"));
  CHECK(contains(page, "&lt;b&gt;"));
  CHECK(std::filesystem::exists(folder / "sweep/report/structure_rms_displacement.svg"));
}
