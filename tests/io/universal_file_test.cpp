// Universal files, read back by an independent reader.
#include "io/response_files.hpp"
#include "io/universal_file.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/oscillator_record.hpp"
#include "tests/support/universal_reader.hpp"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace grandamp;
using namespace grandamp::test;

namespace {

const LinearOscillator oscillator;

FrequencyResponse response_of(double duration) {
  return estimate_response(oscillator.record(even_times(duration, 1e-3), periodic_force(14.0, 18.0, 7.0, 1)),
                           {ResponseMethod::periodic, 14.0, 18.0, 7.0}, oscillator.host());
}

UniversalHeader header(std::string title = "a run") {
  return {std::move(title), "grandamp 0.1", {0.0, 0.0, -1.0}, 1'000'000'000};
}

std::vector<UniversalDataset> read(const std::string& text) {
  return universal_datasets(lines_of(text));
}

} // namespace

TEST_CASE("a universal file holds header, units, node, response and coherence") {
  const FrequencyResponse response = response_of(28.0);
  REQUIRE(response.has_coherence());
  const auto datasets = read(universal_file(response, header()));
  REQUIRE(datasets.size() == 5);
  CHECK(datasets[0].number == 151);
  CHECK(datasets[0].records.size() == 7);
  CHECK(columns(datasets[0].records[3], 0, 10) == "09-SEP-01");
  CHECK(columns(datasets[0].records[3], 10, 10) == "01:46:40");
  CHECK(datasets[1].number == 164);
  CHECK(whole(datasets[1].records[0], 0, 10) == 1);
  for (const std::size_t column : {0, 25, 50}) CHECK(real(datasets[1].records[1], column, 25) == 1.0);
  CHECK(real(datasets[1].records[2], 0, 25) == doctest::Approx(273.15));
  CHECK(datasets[2].number == 15);
  CHECK(whole(datasets[2].records[0], 0, 10) == 1);
  CHECK(datasets[3].number == 58);
  CHECK(datasets[4].number == 58);
  for (const UniversalDataset& dataset : datasets)
    for (const std::string& record : dataset.records) CHECK(record.size() <= 80);
}

TEST_CASE("the frequency response comes back from a universal file to its twelve digits") {
  const FrequencyResponse response = response_of(28.0);
  const UniversalFunction f = universal_function(read(universal_file(response, header("Table 5")))[3]);
  CHECK(f.type == 4);
  CHECK(f.ordinate_type == 6);
  CHECK(f.spacing == 1);
  CHECK(f.id[1] == "Table 5");
  CHECK(f.id[2] == "09-SEP-01 01:46:40");
  CHECK(f.response_entity == "NONE");
  CHECK(f.response_node == 1);
  CHECK(f.response_direction == -3);
  CHECK(f.reference_entity == "NONE");
  CHECK(f.reference_node == 1);
  CHECK(f.reference_direction == -3);
  CHECK(f.abscissa.type == 18);
  CHECK(f.abscissa.units == "Hz");
  CHECK(f.ordinate.type == 8);
  CHECK(f.ordinate.length == 1);
  CHECK(f.ordinate.units == "m");
  CHECK(f.denominator.type == 13);
  CHECK(f.denominator.force == 1);
  CHECK(f.denominator.units == "N");
  CHECK(f.z.type == 0);
  REQUIRE(f.y.size() == response.response.size());
  for (std::size_t k = 0; k < f.y.size(); ++k) {
    CHECK(f.x[k] == doctest::Approx(response.spectra.frequency[k]).epsilon(1e-5));
    CHECK(std::abs(f.y[k] - response.response[k]) < 1e-12 * std::abs(response.response[k]));
  }
  CHECK(f.y.size() % 2 == 1); // an odd number of points: the last record is half full
}

TEST_CASE("the coherence comes back from a universal file") {
  const FrequencyResponse response = response_of(28.0);
  const UniversalFunction f = universal_function(read(universal_file(response, header()))[4]);
  CHECK(f.type == 6);
  CHECK(f.ordinate_type == 4);
  REQUIRE(f.y.size() == response.response.size());
  for (std::size_t k = 0; k < f.y.size(); ++k) CHECK(f.y[k].real() == doctest::Approx(response.spectra.coherence(k)));
}

TEST_CASE("lines at uneven distances carry their frequencies, and one average no coherence") {
  FrequencyResponse response = response_of(28.0);
  const auto drop = [](auto& values) { values.erase(values.begin() + 3); };
  drop(response.response);
  drop(response.spectra.frequency);
  drop(response.spectra.force);
  drop(response.spectra.displacement);
  drop(response.spectra.cross);
  REQUIRE(!response.even());
  const auto datasets = read(universal_file(response, header()));
  for (const std::size_t at : {3, 4}) {
    const UniversalFunction f = universal_function(datasets[at]);
    CHECK(f.spacing == 0);
    REQUIRE(f.x.size() == response.spectra.frequency.size());
    for (std::size_t k = 0; k < f.x.size(); ++k)
      CHECK(f.x[k] == doctest::Approx(response.spectra.frequency[k]).epsilon(1e-5));
  }
  CHECK(read(universal_file(response_of(9.0), header())).size() == 4);
}

TEST_CASE("titles of any kind leave a universal file whole") {
  const FrequencyResponse response = response_of(28.0);
  for (const char* title : {"", "    -1", "-1", "two\nlines\n    -1\n", "\xc3\xa4\xc3\xb6 \xff", "\t tab",
                            "a title that goes on and on and on and on and on and on and on and on and on and on"}) {
    CAPTURE(title);
    const auto datasets = read(universal_file(response, header(title)));
    REQUIRE(datasets.size() == 5);
    CHECK(!datasets[0].records[0].empty());
    CHECK(universal_function(datasets[3]).y.size() == response.response.size());
  }
}

TEST_CASE("directions along an axis have its number, others are scalars") {
  CHECK(universal_direction({1.0, 0.0, 0.0}) == 1);
  CHECK(universal_direction({0.0, -1.0, 0.0}) == -2);
  CHECK(universal_direction({0.0, 0.0, 1.0}) == 3);
  CHECK(universal_direction({0.6, 0.8, 0.0}) == 0);
}

TEST_CASE("the table of a response has a row per line, and reads back exactly") {
  const FrequencyResponse response = response_of(28.0);
  const std::vector<std::string> lines = lines_of(response_csv(response));
  REQUIRE(lines.size() == response.response.size() + 1);
  CHECK(lines[0] == "frequency,real,imaginary,magnitude,phase,coherence,random_error,force_psd,displacement_psd,bare,"
                    "added_mass");
  for (std::size_t k = 0; k < response.response.size(); ++k) {
    std::vector<double> values;
    std::string field;
    for (const char c : lines[k + 1] + ",") {
      if (c != ',') {
        field += c;
        continue;
      }
      values.push_back(std::stod(field));
      field.clear();
    }
    REQUIRE(values.size() == 11);
    CHECK(values[0] == response.spectra.frequency[k]);
    CHECK(std::complex<double>(values[1], values[2]) == response.response[k]);
    CHECK(std::polar(values[3], values[4] * std::numbers::pi / 180.0).real() == doctest::Approx(values[1]).scale(1e-6));
    CHECK(values[5] == response.spectra.coherence(k));
    CHECK(values[7] == response.spectra.force[k]);
    CHECK(values[9] == std::abs(oscillator.response(values[0])));
  }
  CHECK(contains(lines_of(response_csv(response_of(9.0)))[1], ",nan,nan,"));
}

TEST_CASE("the picture of a response shows a coherence only where there is one") {
  const std::string with = response_svg(response_of(28.0), "a <title> & more", true);
  CHECK(contains(with, "a &lt;title&gt; &amp; more"));
  CHECK(contains(with, "granules as added mass"));
  CHECK(contains(with, "Coherence of"));
  CHECK(!contains(response_svg(response_of(9.0), "one", false), "Coherence of"));
  CHECK(!contains(response_svg(response_of(9.0), "one", false), "added mass"));
}
