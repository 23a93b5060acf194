// Excitations of every kind as scenes have them, and tables in files of their own.
#include "io/scene_file.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

using namespace grandamp;

namespace {

const std::string least_scene = "enclosure = {shape = \"box\", size = [1, 2, 3]}\ntime.duration = 1\n";
const std::string on_a_structure = least_scene + "[structure]\nmass = 1\nstiffness = 2000\n";

Excitation excitation_of(const std::string& scene, const std::string& keys) {
  return read_scene_text(scene + "[excitation]\n" + keys, "kinds.toml").scene.excitation;
}

} // namespace

TEST_CASE("excitations of every kind are read") {
  const Excitation base = excitation_of(on_a_structure, "kind = \"base\"\nacceleration = 5\nfrequency = 12\n");
  CHECK(base.kind == ExcitationKind::base);
  CHECK(base.acceleration == 5.0);
  CHECK(base.frequency == 12.0);
  const Excitation chirp = excitation_of(
      on_a_structure, "kind = \"chirp\"\nstatic_deflection = 1e-3\nstart_frequency = 20\nend_frequency = 5\n");
  CHECK(chirp.kind == ExcitationKind::chirp);
  CHECK(chirp.static_deflection == 1e-3);
  CHECK(chirp.start_frequency == 20.0);
  CHECK(chirp.end_frequency == 5.0);
  CHECK(chirp.sweep == Sweep::linear);
  CHECK_FALSE(chirp.sweep_duration);
  const Excitation random =
      excitation_of(on_a_structure, "kind = \"random\"\nforce_rms = 2\nband = [0, 50]\nseed = 7\n");
  CHECK(random.kind == ExcitationKind::random);
  CHECK(random.force_rms == 2.0);
  CHECK(random.band == std::array<double, 2>{0.0, 50.0});
  CHECK(random.seed == 7);
  CHECK_FALSE(random.period);
  CHECK(excitation_of(on_a_structure, "kind = \"random\"\nforce_rms = 2\nband = [0, 50]\nperiod = 8\n").period == 8.0);
  CHECK(
      excitation_of(on_a_structure, "kind = \"chirp\"\nforce = 1\nstart_frequency = 2\nend_frequency = 5\nperiod = 8\n")
          .period == 8.0);
  const Excitation impulse =
      excitation_of(on_a_structure, "kind = \"impulse\"\nforce = 3\nstart = 0.1\npulse_duration = 0.01\n");
  CHECK(impulse.kind == ExcitationKind::impulse);
  CHECK(impulse.force == 3.0);
  CHECK(impulse.start == 0.1);
  CHECK(impulse.pulse_duration == 0.01);
}

TEST_CASE("tables of forces and motions are read beside their scene, and bad ones told with their line") {
  const test::TemporaryFolder folder;
  const auto message_of = [&](const std::string& table, const std::string& scene, const std::string& keys = "") {
    test::write_content(folder / "shaker.csv", table);
    try {
      read_scene_text(scene + "[excitation]\nkind = \"table\"\nfile = \"shaker.csv\"\n" + keys,
                      (folder / "scene.toml").string());
    } catch (const SceneError& error) {
      return format_problems("scene.toml", error.problems());
    }
    return std::string();
  };
  const auto says = [](const std::string& message, const std::string& part) {
    INFO(message, " should have ", part);
    CHECK(message.find(part) != std::string::npos);
  };
  test::write_content(folder / "shaker.csv", "force, time\r\n1,0\r\n+2.5,0.1\r\n\r\n-1e1,0.25\r\n");
  const SceneDocument document =
      read_scene_text(on_a_structure + "[excitation]\nkind = \"table\"\nfile = \"shaker.csv\"\ninterpolation = "
                                       "\"linear\"\n",
                      (folder / "scene.toml").string());
  CHECK(document.scene.excitation.quantity == TableQuantity::force);
  CHECK(document.scene.excitation.interpolation == Interpolation::linear);
  CHECK(document.scene.excitation.times == std::vector<double>{0.0, 0.1, 0.25});
  CHECK(document.scene.excitation.values == std::vector<double>{1.0, 2.5, -10.0});
  // As run, the file is named by its whole path.
  CHECK(document.text.find((folder / "shaker.csv").string()) != std::string::npos);

  CHECK(message_of("time,displacement\n0,0\n5,1\n20,0\n", on_a_structure) == "");
  CHECK(message_of("time,acceleration\n-1,0\n5,1\n20,0\n", least_scene, "direction = [0, 0, 1]\n") == "");
  says(message_of("time,force\n0,1\n0,2\n", on_a_structure), "line 3: time = 0: not after the row before");
  says(message_of("time,force\n0,1\n1,x\n", on_a_structure), "line 3: 'x': not a finite number");
  says(message_of("time,force\n0,1\n1\n", on_a_structure), "line 3: one field where the header has 2");
  says(message_of("time,force\n0,1\n1,2,3\n", on_a_structure), "line 3: more fields than the 2");
  says(message_of("time,force\n0,1\n", on_a_structure), "a single row below the header");
  says(message_of("time,speed\n0,1\n", on_a_structure), "line 1: no header of two columns");
  says(message_of("", on_a_structure), "line 1: no header of two columns");
  says(message_of("time,force\n0,1\n1,2\n", least_scene), "a force needs a [structure] to act on");
  says(message_of("time,force\n0,1\n1,2\n", on_a_structure, "direction = [1, 0, 0]\n"),
       "excitation.direction = [1, 0, 0]: does not apply: the structure has one");
  says(message_of("time,displacement\n0,0\n0.5,1\n", least_scene), "known from 0 to 0.5 s, not for the whole run");
  says(message_of("time,displacement\n0.5,0\n50,1\n", on_a_structure), "known from 0.5 to 50 s");
  says(message_of("time,displacement\n0,0\n50,1\n", on_a_structure, "interpolation = \"linear\"\n"),
       "a displacement with kinks");
  CHECK_THROWS_WITH_AS(read_scene_text(on_a_structure + "[excitation]\nkind = \"table\"\nfile = \"none.csv\"\n",
                                       (folder / "scene.toml").string()),
                       doctest::Contains("cannot be read: no such file"), FileError);
}
