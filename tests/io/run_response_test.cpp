// Runs that are driven over a band, and what their folders then tell of the frequency response; free decay.
#include "tests/io/io_support.hpp"
#include "tests/support/oscillator_record.hpp"
#include "tests/support/scene_texts.hpp"
#include "tests/support/universal_reader.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <complex>

using namespace grandamp;
using namespace grandamp::test;

namespace {

/// The structure of the paper's Table 5, 1 % of critical damping, bare.
std::string bare_scene(const std::string& excitation, double duration) {
  return R"(title = "bare"
seed = 1
gravity = [0, 0, -9.81]
[enclosure]
shape = "box"
size = [0.025, 0.025, 0.0359]
[structure]
mass = 0.1
stiffness = 1000.0
damping = 0.2
direction = [0, 0, 1]
)" + (excitation.empty() ? "displacement = 0.01\n" : "[excitation]\n" + excitation) +
         "[time]\nduration = " + std::to_string(duration) + "\nstep = 2.5e-4\n[output]\nhistory_interval = 1.0e-3\n" +
         "energy = false\n";
}

struct Row {
  double frequency;
  std::complex<double> response;
  double coherence, bare, added_mass;
};

std::vector<std::vector<double>> table(const std::string& text) {
  std::vector<std::vector<double>> rows;
  const auto lines = lines_of(text);
  for (std::size_t n = 1; n < lines.size(); ++n) {
    rows.emplace_back();
    std::size_t begin = 0;
    while (begin <= lines[n].size()) {
      const std::size_t end = std::min(lines[n].find(',', begin), lines[n].size());
      rows.back().push_back(std::stod(lines[n].substr(begin, end - begin)));
      begin = end + 1;
    }
  }
  return rows;
}

std::vector<Row> response_table(const std::string& text) {
  std::vector<Row> rows;
  for (const auto& values : table(text))
    rows.push_back({values.at(0), {values[1], values[2]}, values[5], values[9], values.at(10)});
  return rows;
}

/// Of the lines that reach half of the peak, against the closed form.
double error_around_peak(const std::vector<Row>& rows) {
  const LinearOscillator structure;
  double top = 0.0, error = 0.0;
  for (const Row& row : rows) top = std::max(top, row.bare);
  for (const Row& row : rows) {
    const std::complex<double> exact = structure.response(row.frequency);
    CHECK(row.bare == doctest::Approx(std::abs(exact)));
    if (row.bare >= 0.5 * top) error = std::max(error, std::abs(row.response / exact - 1.0));
  }
  CHECK(top > 0.04); // the record resolves the peak: 0.05 m/N
  return error;
}

nlohmann::json summary_of(const TemporaryFolder& folder, const std::string& run) {
  return nlohmann::json::parse(content_of(folder / (run + "/summary.json")));
}

} // namespace

TEST_CASE("random and sweeping forces find the bare structure within 1 % around its peak") {
  struct Kind {
    std::string name;
    const char *excitation, *method;
    double duration, most;
  };
  for (const Kind& kind :
       {Kind{"periodic random", "kind = \"random\"\nforce_rms = 1.0\nband = [12, 20]\nperiod = 16.0\n", "periods", 40.0,
             2e-3},
        Kind{"sweep after sweep",
             "kind = \"chirp\"\nforce = 1.0\nstart_frequency = 12\nend_frequency = 20\nperiod = 16.0\n", "periods",
             40.0, 2e-3},
        Kind{"one sweep", "kind = \"chirp\"\nforce = 1.0\nstart_frequency = 12\nend_frequency = 20\n", "transient",
             40.0, 5e-3},
        Kind{"a blow", "kind = \"impulse\"\nforce = 1.0\npulse_duration = 0.01\n", "transient", 16.0, 5e-3}}) {
    CAPTURE(kind.name);
    const TemporaryFolder folder;
    const bool blow = kind.name == "a blow";
    write_content(folder / "bare.toml",
                  replaced(bare_scene(kind.excitation, kind.duration), "history_interval = 1.0e-3",
                           blow ? "history_interval = 2.5e-4" : "history_interval = 1.0e-3"));
    const Outcome outcome = program(folder, "run bare.toml --quiet");
    REQUIRE(outcome.status == 0);
    const double error = error_around_peak(response_table(content_of(folder / "bare/response.csv")));
    MESSAGE(kind.name << ": " << 100.0 * error << " % at most");
    CHECK(error < kind.most);
    const auto response = summary_of(folder, "bare").at("response");
    CHECK(response["method"] == kind.method);
    CHECK(response["fit"]["damping_ratio"].get<double>() == doctest::Approx(0.01).epsilon(0.01));
    CHECK(response["fit"]["natural_frequency"].get<double>() == doctest::Approx(15.9155).epsilon(1e-3));
    CHECK(response["fit"]["peak_magnitude"].get<double>() == doctest::Approx(0.05).epsilon(0.01));
    if (kind.method == std::string("periods"))
      CHECK(response["mean_coherence"].get<double>() > 0.9999);
    else
      CHECK(response["mean_coherence"].is_null());
  }
}

TEST_CASE("Welch's segments of a random force that never repeats find the peak within 1 %") {
  const TemporaryFolder folder;
  write_content(folder / "bare.toml", bare_scene("kind = \"random\"\nforce_rms = 1.0\nband = [12, 20]\n", 600.0));
  REQUIRE(program(folder, "run bare.toml --quiet").status == 0);
  const auto response = summary_of(folder, "bare").at("response");
  CHECK(response["method"] == "welch");
  CHECK(response["averages"] > 15);
  MESSAGE("peak " << response["fit"]["peak_magnitude"] << " m/N, damping ratio " << response["fit"]["damping_ratio"]
                  << ", said bias " << response["bias"] << ", random error " << response["random_error"]);
  CHECK(response["fit"]["peak_magnitude"].get<double>() == doctest::Approx(0.05).epsilon(0.01));
  CHECK(response["mean_coherence"].get<double>() > 0.97);

  // Shorter segments, asked for, are biased, and that is said.
  const Outcome outcome = program(folder, "export bare response --segment 10 -o short.csv");
  CHECK(outcome.status == 0);
  CHECK(contains(outcome.errors, "lowers the peak"));
  double top = 0.0;
  for (const Row& row : response_table(content_of(folder / "short.csv"))) top = std::max(top, std::abs(row.response));
  CHECK(top < 0.048);
}

TEST_CASE("with granules the response has a coherence, and all files of it agree") {
  const TemporaryFolder folder;
  std::string scene = replaced(bare_scene("kind = \"random\"\nforce_rms = 0.5\nband = [8, 24]\nperiod = 1.0\n", 6.0),
                               "step = 2.5e-4", "steps_per_contact = 8");
  scene += R"([contact.granule]
stiffness = 1.0e6
reference_radius = 3.0e-3
restitution = 0.89
friction = 0.52
[[granules]]
count = 12
radius = 2.5e-3
density = 7800
)";
  write_content(folder / "loaded.toml", scene);
  REQUIRE(program(folder, "run loaded.toml --quiet").status == 0);
  const auto rows = response_table(content_of(folder / "loaded/response.csv"));
  REQUIRE(rows.size() == 17);
  const auto response = summary_of(folder, "loaded").at("response");
  CHECK(response["averages"] >= 3);
  const double coherence = response["mean_coherence"];
  MESSAGE("mean coherence around the peak " << coherence);
  CHECK(coherence > 0.3);
  CHECK(coherence < 0.99999);
  double top = 0.0;
  for (const Row& row : rows) {
    CHECK(row.coherence >= 0.0);
    CHECK(row.coherence <= 1.0);
    top = std::max(top, std::abs(row.response));
    const LinearOscillator heavier{.mass = 0.1 + 12 * 7800 * 4.0 / 3.0 * std::numbers::pi * std::pow(2.5e-3, 3)};
    CHECK(row.added_mass == doctest::Approx(std::abs(heavier.response(row.frequency))));
  }
  CHECK(response["peak_magnitude"] == top);

  const auto datasets = universal_datasets(lines_of(content_of(folder / "loaded/response.unv")));
  REQUIRE(datasets.size() == 5);
  const UniversalFunction frf = universal_function(datasets[3]), common = universal_function(datasets[4]);
  CHECK(frf.id[1] == "bare");
  CHECK(frf.response_direction == 3);
  REQUIRE(frf.y.size() == rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK(frf.x[k] == doctest::Approx(rows[k].frequency).epsilon(1e-5));
    CHECK(std::abs(frf.y[k] - rows[k].response) < 1e-11 * std::abs(rows[k].response));
    CHECK(common.y[k].real() == doctest::Approx(rows[k].coherence));
  }
  CHECK(contains(content_of(folder / "loaded/response.svg"), "granules as added mass"));

  // The same again by export, in each of its forms.
  CHECK(program(folder, "export loaded response -o again.csv").status == 0);
  CHECK(content_of(folder / "again.csv") == content_of(folder / "loaded/response.csv"));
  CHECK(program(folder, "export loaded response -o again.svg").status == 0);
  CHECK(content_of(folder / "again.svg") == content_of(folder / "loaded/response.svg"));
  CHECK(program(folder, "export loaded response -o again.uff").status == 0);
  CHECK(universal_function(universal_datasets(lines_of(content_of(folder / "again.uff")))[3]).y == frf.y);
}

TEST_CASE("a response that cannot be had is refused with the reason, and a run goes on without it") {
  const TemporaryFolder folder;
  const std::string random = "kind = \"random\"\nforce_rms = 1.0\nband = [12, 20]\n";
  write_content(folder / "short.toml", bare_scene(random + "period = 16.0\n", 4.0));
  const Outcome run = program(folder, "run short.toml");
  CHECK(run.status == 0);
  CHECK(contains(run.errors, "no frequency response: the run of 4 s is shorter than one period of the force, 16 s"));
  CHECK(contains(summary_of(folder, "short")["response"]["message"].get<std::string>(), "shorter than one period"));
  CHECK(!std::filesystem::exists(folder / "short/response.csv"));
  const Outcome again = program(folder, "export short response -o x.csv");
  CHECK(again.status == 2);
  CHECK(contains(again.errors, "shorter than one period"));
  CHECK(!std::filesystem::exists(folder / "x.csv"));

  for (const auto& [arguments, reason] :
       {std::pair{"export short response -o x.txt", ".csv, .unv or .uff (universal file 58), or .svg"},
        {"export short response -o x.csv --time 1", "--time goes with granules"},
        {"export short history -o x.csv --segment 1", "--settling and --segment go with response"},
        {"export short decay -o x.csv", "no free vibration"},
        {"export short response -o x.csv --settling -1", "--settling"},
        {"export short response -o x.csv --segment 0", "--segment"}}) {
    CAPTURE(arguments);
    const Outcome outcome = program(folder, arguments);
    CHECK(outcome.status == 2);
    CHECK(contains(outcome.errors, reason));
  }
  CHECK(program(folder, "export nowhere response -o x.csv").status == 4);

  write_content(folder / "coarse.toml",
                replaced(bare_scene(random, 4.0), "history_interval = 1.0e-3", "history_interval = 0.02"));
  CHECK(contains(program(folder, "run coarse.toml").errors, "shorten output.history_interval"));
  write_content(folder / "blow.toml", bare_scene("kind = \"impulse\"\nforce = 1.0\npulse_duration = 0.01\n", 16.0));
  CHECK(contains(program(folder, "run blow.toml").errors, "take the pulse of 0.01 s for weaker"));
  write_content(folder / "still.toml", replaced(bare_scene(random, 30.0), "force_rms = 1.0", "force_rms = 0.0"));
  CHECK(contains(program(folder, "run still.toml").errors, "there is no force"));
  write_content(folder / "sine.toml", bare_scene("kind = \"harmonic\"\nforce = 1.0\nfrequency = 15.0\n", 4.0));
  CHECK(program(folder, "run sine.toml --quiet").errors.empty());
  CHECK(contains(program(folder, "export sine response -o x.csv").errors, "a harmonic force has one frequency"));
}

TEST_CASE("a free vibration leaves its decay, and a new run in the folder takes it away") {
  const TemporaryFolder folder;
  write_content(folder / "free.toml", bare_scene("", 2.0));
  REQUIRE(program(folder, "run free.toml --quiet").status == 0);
  const auto rows = table(content_of(folder / "free/decay.csv"));
  REQUIRE(rows.size() > 25);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK(rows[k][0] == static_cast<double>(k + 1));
    CHECK(rows[k][5] == doctest::Approx(0.01).epsilon(1e-3));
    if (k > 0) CHECK(rows[k][2] < rows[k - 1][2]);
  }
  CHECK(contains(content_of(folder / "free/decay.svg"), "damping ratio"));
  CHECK(program(folder, "export free decay -o again.csv").status == 0);
  CHECK(content_of(folder / "again.csv") == content_of(folder / "free/decay.csv"));
  CHECK(program(folder, "export free decay -o again.svg").status == 0);
  CHECK(content_of(folder / "again.svg") == content_of(folder / "free/decay.svg"));
  CHECK(contains(program(folder, "export free response -o x.csv").errors, "the vibration is free"));

  write_content(folder / "sine.toml", bare_scene("kind = \"harmonic\"\nforce = 1.0\nfrequency = 15.0\n", 0.5));
  REQUIRE(program(folder, "run sine.toml -o free --force --quiet").status == 0);
  CHECK(!std::filesystem::exists(folder / "free/decay.csv"));
}
