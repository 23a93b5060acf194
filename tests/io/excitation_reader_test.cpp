// Excitations of every kind and structures of several modes as scenes have them, and what they have in files.
#include "io/scene_file.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
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

TEST_CASE("structures of several modes are read, from the scene or from a file of matrices") {
  const std::string head = least_scene + "[structure]\n";
  const Structure two =
      read_scene_text(
          head + "direction = [1, 0, 0]\nmodes = [{mass = 2, frequency = 10, damping_ratio = 0.01, shape = [1, "
                 "0, 0.5]}, {mass = 1, stiffness = 3, damping = 0.1, shape = [0, 1, 0], force_shape = 0.7, "
                 "displacement = 1e-3, velocity = 2}]\n",
          "modes.toml")
          .scene.structure.value();
  const double stiffness = 2.0 * 400.0 * std::numbers::pi * std::numbers::pi;
  REQUIRE(two.modes.size == 2);
  CHECK(two.modes.mass == std::vector<double>{2.0, 0.0, 0.0, 1.0});
  CHECK(two.modes.stiffness[0] == doctest::Approx(stiffness));
  CHECK(two.modes.stiffness[3] == 3.0);
  CHECK(two.modes.damping[0] == doctest::Approx(0.02 * std::sqrt(2.0 * stiffness)));
  CHECK(two.modes.attachment == std::vector<double>{1.0, 0.0, 0.0, 1.0, 0.5, 0.0});
  CHECK(two.modes.force == std::vector<double>{1.0, 0.7});
  CHECK(two.modes.displacement == std::vector<double>{0.0, 1e-3});
  CHECK(two.modes.velocity == std::vector<double>{0.0, 2.0});

  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& matrices) {
    test::write_content(folder / "model.csv", matrices);
    return read_scene_text(head + "matrices = \"model.csv\"\n", (folder / "scene.toml").string());
  };
  const SceneDocument document =
      read("mass,1,0\nmass,0,2\nstiffness,5,-1\nstiffness,-1,4\nx,0,1\nz,1,0.5\nforce,1,0\n");
  const SeveralModes& modes = document.scene.structure->modes;
  CHECK(modes.size == 2);
  CHECK(modes.mass == std::vector<double>{1.0, 0.0, 0.0, 2.0});
  CHECK(modes.stiffness == std::vector<double>{5.0, -1.0, -1.0, 4.0});
  CHECK(modes.damping == std::vector<double>(4, 0.0));
  CHECK(modes.attachment == std::vector<double>{0.0, 1.0, 0.0, 0.0, 1.0, 0.5});
  CHECK(modes.force == std::vector<double>{1.0, 0.0});
  CHECK(document.text.find((folder / "model.csv").string()) != std::string::npos);
  // Without a row of its own the force acts on the enclosure, along the direction (z).
  CHECK(read("mass,1,0\nmass,0,2\nstiffness,5,-1\nstiffness,-1,4\nz,1,0.5\n").scene.structure->modes.force ==
        std::vector<double>{1.0, 0.5});

  const auto message_of = [&](const std::string& matrices) {
    try {
      read(matrices);
    } catch (const SceneError& error) {
      return format_problems("scene.toml", error.problems());
    }
    return std::string("(no error)");
  };
  for (const auto& [matrices, part] : std::vector<std::pair<std::string, std::string>>{
           {"", "no rows"},
           {"mess,1\n", "line 1: 'mess': unknown row; allowed: mass, damping"},
           {"mass,1,0\nmass,0\n", "line 2: 1 numbers, where the first row has 2"},
           {"mass,1,x\n", "line 1: 'x': not a finite number"},
           {"mass,1,0\nstiffness,1,0\nstiffness,0,1\nz,1,0\n", "1 rows of mass; allowed: 2"},
           {"mass,1\nmass,1\n", "line 2: more than 1 rows of mass"},
           {"mass,0\nstiffness,1\nz,1\n", "mass: some motion has no mass"},
           {"mass,1\nstiffness,-1\nz,1\n", "stiffness: some motion would gain energy"},
           {"mass,1\nstiffness,1\n", "attachment: the enclosure does not move"},
           {"mass,2,1\nmass,0,2\nstiffness,1,0\nstiffness,0,1\nz,1,0\n", "mass: not symmetric"}}) {
    CAPTURE(matrices);
    const std::string message = message_of(matrices);
    CAPTURE(message);
    CHECK(message.find(part) != std::string::npos);
    CHECK(message.find("structure.matrices = 'model.csv'") != std::string::npos);
  }
}
