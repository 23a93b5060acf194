// Runs of each excitation and of several modes, cut and resumed from their files.
#include "tests/exactness/exactness_support.hpp"
#include "tests/support/scene_texts.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE("excitations and modes - a run cut and resumed has the results of one never cut") {
  const TemporaryFolder folder;
  write_content(folder / "table.csv", "time,force\n0,0\n0.01,1\n0.02,-1\n0.03,0.5\n0.06,0\n");
  write_content(folder / "model.csv",
                "mass,0.02,0\nmass,0,0.05\nstiffness,300,-100\nstiffness,-100,400\ndamping,0.05,0\n"
                "damping,0,0.1\nx,0,0.3\nz,1,0\nforce,0.5,0.5\n");
  const std::string sine = "kind = \"harmonic\"\nforce = 0.5\nfrequency = 16.0";
  const std::string one = "mass = 0.02\nstiffness = 200.0\ndamping = 0.05";
  const std::vector<std::string> scenes{
      replaced(small_scene(), sine, "kind = \"chirp\"\nforce = 0.5\nstart_frequency = 5\nend_frequency = 50"),
      replaced(small_scene(), sine, "kind = \"random\"\nforce_rms = 0.5\nband = [10, 900]\nseed = 2"),
      replaced(small_scene(), sine, "kind = \"table\"\nfile = \"table.csv\""),
      replaced(small_scene(), one, "matrices = \"model.csv\"")};
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    CAPTURE(k);
    const SceneDocument document = read_scene_text(scenes[k], (folder / "scene.toml").string());
    const std::filesystem::path whole = folder / ("whole" + std::to_string(k)),
                                cut = folder / ("cut" + std::to_string(k));
    run_scene(document, whole, threads(1));
    REQUIRE(run_scene(document, cut, stopping_after(3456)).status == RunStatus::interrupted);
    REQUIRE(resume_run(cut, {}, stopping_after(2345)).status == RunStatus::interrupted);
    REQUIRE(resume_run(cut, {}, threads(1)).status == RunStatus::done);
    check_same(outcomes_of(cut), outcomes_of(whole));
    const auto structure = nlohmann::json::parse(content_of(whole / "summary.json"))["structure"];
    CHECK(structure["rms_displacement"] > 0.0);
    CHECK(structure.contains("modes") == (k == 3));
    if (k == 3) CHECK(structure["modes"].size() == 2);
  }
}
