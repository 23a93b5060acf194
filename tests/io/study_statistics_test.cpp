// Means, scatter, frontier and advice of a study, from runs made up so that the answers are known.
#include "io/study_report.hpp"
#include "io/svg_plot.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace grandamp;

namespace {

StudySetting setting(const std::string& name, double contact_error) {
  StudySetting one{.name = name, .group = "steps", .label = name};
  one.contact = {contact_error, "somewhere"};
  return one;
}

StudyCase run(const std::string& name, int seed, double time, double amplitude) {
  StudyCase one;
  one.setting = name;
  one.seed = seed;
  one.wall_time = 2.0 * time;
  one.processor_time = time;
  one.observables = {{"amplitude", amplitude}, {"dissipated", 2.0}, {"contacts_per_granule", amplitude}};
  return one;
}

/// Three settings and a model of another kind, three seeds; "own" is 5 % off, "middle" by 0.5 %.
struct Example {
  Example() {
    settings.settings = {setting("own", 0.1), setting("middle", 0.01), setting("fine", 0.001), setting("soft", 0.0)};
    settings.settings[0].own = true;
    settings.settings[2].reference = true;
    settings.settings[3].other_truth = true;
    const double scatter[] = {-0.01, 0.0, 0.01};
    for (int seed = 0; seed < 3; ++seed) {
      // The machine is twice as slow while the second seed runs.
      const double slow = seed == 1 ? 2.0 : 1.0;
      cases.done.push_back(run("own", seed, 1.0 * slow, 1.05 + scatter[seed]));
      cases.done.push_back(run("middle", seed, 3.0 * slow, 1.005 + scatter[seed]));
      cases.done.push_back(run("fine", seed, 9.0 * slow, 1.0 + scatter[seed]));
      cases.done.push_back(run("soft", seed, 0.1 * slow, 2.0 + 10.0 * scatter[seed]));
    }
    cases.planned = cases.done.size();
  }
  StudySettings settings;
  StudyCases cases;
};

} // namespace

TEST_CASE("a study's times are shares of the own settings' in the same turn, and errors carry the seeds' scatter") {
  const Example example;
  const StudyTable table = study_table(example.settings, example.cases);
  REQUIRE(table.rows.size() == 4);
  REQUIRE(table.own != nullptr);
  REQUIRE(table.reference != nullptr);
  CHECK(table.seeds == 3);
  CHECK(table.rows[1].time == doctest::Approx(3.0));
  CHECK(table.rows[1].time_spread == doctest::Approx(0.0)); // the slow turn was slow for all
  CHECK(table.rows[1].wall_time == doctest::Approx(6.0));
  // Scatter 0.01 in each, so 0.01 / sqrt(3) of a mean; the other model's is not in it.
  const StudyDifference* own = table.rows[0].find("amplitude");
  REQUIRE(own != nullptr);
  CHECK(own->relative == doctest::Approx(0.05));
  CHECK(own->standard_error == doctest::Approx(0.01 * std::sqrt(2.0 / 3.0)));
  CHECK(own->resolved());
  const StudyDifference* middle = table.rows[1].find("amplitude");
  CHECK(middle->relative == doctest::Approx(0.005));
  CHECK_FALSE(middle->resolved());
  CHECK(table.rows[1].error() == doctest::Approx(0.005));
  CHECK(table.rows[1].scatter() == doctest::Approx(3.0 * middle->standard_error));
  CHECK(table.rows[2].find("amplitude")->relative == 0.0);
}

TEST_CASE("a study recommends the fastest settings within an error, never another model, never missed contacts") {
  Example example;
  const StudyTable table = study_table(example.settings, example.cases);
  CHECK(advise(table, 0.1).by_observables == &table.rows[0]);
  CHECK(advise(table, 0.01).by_observables == &table.rows[1]);
  CHECK(advise(table, 0.01).by_contact == &table.rows[1]);
  CHECK(advise(table, 0.001).by_contact == &table.rows[2]);
  CHECK(advise(table, 1e-4).by_contact == nullptr);
  // 0.005 +- 0.024 is no proof of 0.01: more seeds are asked for.
  CHECK(advise(table, 0.01).seeds_needed > 3);
  const std::vector<const StudyRow*> best = frontier(table);
  REQUIRE(best.size() == 3);
  CHECK(best.front() == &table.rows[0]);

  StudyCase audit = run("middle", 0, 1.0, 1.0);
  audit.audit = true;
  audit.missed = 1;
  example.cases.done.push_back(audit);
  const StudyTable missing = study_table(example.settings, example.cases);
  CHECK(missing.rows[1].missed == 1);
  CHECK(missing.rows[1].runs == 3);
  CHECK(advise(missing, 0.01).by_observables == &missing.rows[2]);
}

TEST_CASE("with one seed a study knows no scatter and says so") {
  Example example;
  std::erase_if(example.cases.done, [](const StudyCase& one) { return one.seed > 0; });
  const StudyTable table = study_table(example.settings, example.cases);
  CHECK(std::isnan(table.rows[0].find("amplitude")->standard_error));
  CHECK_FALSE(table.rows[0].find("amplitude")->resolved());
  StudyReport report;
  report.table = &table;
  report.settings = &example.settings;
  CHECK(report.paragraph().find("the scatter is not known") != std::string::npos);
  CHECK(report.json().find("\"standard_error\": null") != std::string::npos);
}

TEST_CASE("a study of which little is done still writes its tables") {
  Example example;
  example.cases.done.clear();
  StudyCase stopped = run("own", 0, 1.0, 1.0);
  stopped.stopped = "an overlap too deep, \"quoted\"";
  example.cases.done.push_back(stopped);
  const StudyTable table = study_table(example.settings, example.cases);
  StudyReport report;
  report.table = &table;
  report.settings = &example.settings;
  CHECK(report.paragraph().empty());
  CHECK(report.csv().find("\"an overlap too deep, \"\"quoted\"\"\"") != std::string::npos);
  CHECK(report.markdown().find("stopped: an overlap too deep") != std::string::npos);
  CHECK(report.json().find("\"by_observables\": null") != std::string::npos);
}

TEST_CASE("a plot leaves out what an axis cannot show and escapes what it writes") {
  Plot plot;
  plot.title = "a < b & c";
  plot.x = {"x", true};
  plot.y = {"y", true};
  plot.series.push_back({.name = "s", .points = {{1.0, 1.0}, {0.0, 1.0}, {1.0, std::nan("")}, {10.0, 5.0, 0.0, 6.0}}});
  const std::string svg = plot.svg();
  CHECK(svg.find("a &lt; b &amp; c") != std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++circles;
  CHECK(circles == 3); // two points and the legend
  CHECK(Plot{}.svg().find("</svg>") != std::string::npos);
}
