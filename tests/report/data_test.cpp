// What a page carries: nothing lost by making it small, nothing that could run by what users wrote.
#include "io/report_data.hpp"
#include "io/report_page.hpp"
#include "io/report_still.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

using namespace grandamp;
using namespace grandamp::report;

namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("thinned rows keep every peak within its bucket, and few rows stay as they are") {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  Rows rows;
  rows.columns.resize(2);
  for (int k = 0; k < 70'001; ++k) {
    rows.time.push_back(1e-4 * k);
    rows.columns[0].push_back(noise(random));
    rows.columns[1].push_back(k == 12'345 ? -1e6 : std::sin(1e-3 * k));
  }
  const Rows thin = thinned(rows, 2000);
  REQUIRE(thin.time.size() == 2000);
  REQUIRE(std::is_sorted(thin.time.begin(), thin.time.end()));
  for (const std::size_t c : {0U, 1U}) {
    std::size_t row = 0;
    for (std::size_t bucket = 0; bucket < 1000; ++bucket) {
      const double a = thin.columns[c][2 * bucket], b = thin.columns[c][2 * bucket + 1];
      double low = INFINITY, high = -INFINITY;
      for (; row < rows.time.size() && rows.time[row] <= thin.time[2 * bucket + 1]; ++row) {
        low = std::min(low, rows.columns[c][row]);
        high = std::max(high, rows.columns[c][row]);
      }
      REQUIRE(std::min(a, b) == low);
      REQUIRE(std::max(a, b) == high);
    }
    CHECK(row == rows.time.size());
  }
  CHECK(thinned(rows, 70'001).columns[0] == rows.columns[0]);
}

TEST_CASE("base64 as RFC 4648 has it") {
  const auto of = [](const std::string& text) { return base64(std::as_bytes(std::span(text))); };
  CHECK(of("").empty());
  CHECK(of("f") == "Zg==");
  CHECK(of("fo") == "Zm8=");
  CHECK(of("foo") == "Zm9v");
  CHECK(of("foobar") == "Zm9vYmFy");
  CHECK(of("\xff\xfe\x00") == "//4=");
}

TEST_CASE("positions in 16 bits are off by half a step at most") {
  for (int k = 0; k <= 1000; ++k) {
    const double x = -0.3 + 0.0017 * k;
    const double back = -0.3 + quantised(x, -0.3, 1.4, 65535) / 65535.0 * 1.7;
    CHECK(std::abs(back - x) <= 0.5 * 1.7 / 65535.0 * 1.0001);
  }
  CHECK(quantised(9.0, 0.0, 1.0, 255) == 255);
  CHECK(quantised(-9.0, 0.0, 1.0, 255) == 0);
  CHECK(quantised(1.0, 1.0, 1.0, 255) == 0);
}

TEST_CASE("units that read well") {
  CHECK(readable(4.661e-3, "m") == "4.661 mm");
  CHECK(readable(0.0, "m") == "0 m");
  CHECK(readable(-2.5e4, "N") == "-25 kN");
  CHECK(readable(16.8e-6, "kg") == "16.8 mg");
  CHECK(readable(3.2e-7, "s", 2) == "320 ns");
  CHECK(readable(12.0, "1") == "12");
  CHECK(readable(std::nan(""), "m") == "not known");
}

TEST_CASE("what users wrote cannot become a part of the page's code") {
  const std::string evil = "</script><script>alert(1)</script><img src=x onerror=\"alert('2')\"> & \x01 {{title}}";
  Page page(evil, evil);
  page.section("one", evil);
  Plot plot;
  plot.title = evil;
  plot.x.name = plot.y.name = evil;
  plot.series.push_back({.name = evil, .points = {{.x = 1.0, .y = 2.0, .label = evil}}});
  page.add(figure_of(plot, "evil", evil, table({evil}, {{evil}}, evil)));
  page.add(facts({{evil, evil}}));
  page.facts()["evil"] = evil;
  const std::string text = page.text();
  CHECK_FALSE(holds(text, "<script>alert"));
  CHECK_FALSE(holds(text, "<img src=x"));
  CHECK_FALSE(holds(text, "\x01"));
  CHECK(holds(text, "{{title}}")); // a value is not filled in again
  CHECK(holds(text, "&lt;/script&gt;"));
  CHECK(embedded({{"a", "</script>"}}) == "{\"a\":\"\\u003c/script>\"}");
  CHECK(escaped("<a href=\"b\">'&'</a>") == "&lt;a href=&quot;b&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
}

TEST_CASE("a page asks for nothing from anywhere") {
  Page page("A title", "");
  Plot plot;
  plot.series.push_back({.name = "one", .points = {{.x = 1.0, .y = 2.0}}});
  page.add(figure_of(plot, "chart", "", ""));
  const std::string text = page.text();
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http", "sourceMappingURL"})
    CHECK_FALSE(holds(text, outside));
  CHECK(holds(text, "default-src 'none'"));
  CHECK(holds(text, "Chart.js v"));
  CHECK_FALSE(holds(text, "THREE"));
}

TEST_CASE("of granules in a picture those that others hide are left out, and none that shows") {
  Enclosure enclosure;
  enclosure.size = {1.0, 1.0, 1.0};
  const std::vector<Vector3> alone{{0.5, 0.5, 0.5}};
  const auto circles = [](const std::string& svg) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  CHECK(circles(granules_picture("", enclosure, alone, {0.1}, {"#000000"})) == 1);
  // The second lies within the first.
  CHECK(circles(granules_picture("", enclosure, {{0.5, 0.5, 0.5}, {0.51, 0.52, 0.5}}, {0.2, 0.05},
                                 {"#000000", "#ffffff"})) == 1);
  CHECK(circles(granules_picture("", enclosure, {{0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}}, {0.1, 0.1},
                                 {"#000000", "#ffffff"})) == 2);
  CHECK(scale_colour(0.0) == "#440154");
  CHECK(scale_colour(1.0) == "#fde725");
}
