// Good scenes: what is read, defaults, overrides, the text as run, and where a key stands.
#include "io/scene_file.hpp"
#include "tests/support/same_scene.hpp"
#include "tests/support/scene_texts.hpp"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <unistd.h>

using namespace grandamp;
using test::good_scene;
using test::replaced;
using test::same_scene;

namespace {

const std::filesystem::path scenes = std::filesystem::path(GRANDAMP_SOURCE_DIR) / "io" / "scenes";

/// The smallest scene: an empty box that stands still.
const std::string least_scene = "enclosure = {shape = \"box\", size = [1, 2, 3]}\ntime.duration = 1\n";

/// A folder that is gone at the end of its test.
class Folder {
public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("grandamp_scene_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_ / "elsewhere");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

private:
  std::filesystem::path path_;
};

double sphere_mass(double density, double radius) {
  return density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

} // namespace

TEST_CASE("every key of a whole scene arrives") {
  const SceneDocument document = read_scene_text(good_scene, "good.toml");
  const Scene& scene = document.scene;
  CHECK(scene.title == "good");
  CHECK(scene.seed == 7);
  CHECK(scene.gravity == Vector3{0.0, 0.0, -9.81});
  CHECK(scene.enclosure.shape == EnclosureShape::box);
  CHECK(scene.enclosure.size == Vector3{0.025, 0.025, 0.0359});
  REQUIRE(scene.populations.size() == 1);
  CHECK(scene.populations[0].name == "acrylic");
  CHECK(scene.populations[0].count == 317);
  CHECK(scene.populations[0].radius == 1.85e-3);
  CHECK(scene.populations[0].mass == doctest::Approx(sphere_mass(1190.0, 1.85e-3)).epsilon(1e-14));
  CHECK_FALSE(scene.populations[0].placed);
  CHECK(scene.packing == PackingKind::settled);
  CHECK(scene.contact.damping == NormalDamping::tsuji);
  CHECK(scene.contact.friction == FrictionLaw::coulomb);
  CHECK(scene.contact.granule.stiffness == 1.0e7);
  CHECK(scene.contact.granule.reference_radius == 3.0e-3);
  CHECK(scene.contact.granule.restitution == 0.89);
  CHECK(scene.contact.granule.friction == 0.52);
  REQUIRE(scene.contact.wall);
  CHECK(scene.contact.wall->stiffness == 1.3e7);
  CHECK(scene.contact.wall->restitution == 0.9);
  CHECK(scene.contact.wall->friction == 0.5);
  REQUIRE(scene.structure);
  CHECK(scene.structure->mass == 0.1);
  CHECK(scene.structure->stiffness == 1000.0);
  CHECK(scene.structure->damping == 0.2);
  CHECK(scene.structure->direction == Vector3{0.0, 0.0, 1.0}); // given as [0, 0, 2]
  CHECK(scene.excitation.kind == ExcitationKind::harmonic);
  CHECK(scene.excitation.static_deflection == 0.5e-3);
  CHECK(scene.excitation.frequency == 15.91);
  CHECK(scene.time.duration == 7.0);
  CHECK(scene.time.steps_per_contact == 8.0);
  CHECK(scene.verlet.policy == ListPolicy::guarded);
  CHECK(scene.output.window == std::array{3.5, 7.0});
  CHECK(document.notes.empty());
  CHECK(document.text == good_scene);
}

TEST_CASE("an integer that is no double becomes the nearest one, wherever a number is asked for") {
  const Scene scene = read_scene_text(R"(
enclosure = {shape = "box", size = [1, 2, 9007199254740993]}
gravity = [0, 0, -9007199254740993]
time.duration = 9007199254740993
output = {window = [1, 9007199254740993], history_interval = 9007199254740993}
)",
                                      "integers.toml")
                          .scene;
  const double nearest = 9007199254740992.0;
  CHECK(scene.enclosure.size == Vector3{1.0, 2.0, nearest});
  CHECK(scene.gravity == Vector3{0.0, 0.0, -nearest});
  CHECK(scene.time.duration == nearest);
  CHECK(scene.output.window == std::array{1.0, nearest});
  CHECK(scene.output.history_interval == nearest);
}

TEST_CASE("what a scene leaves out has the contract's defaults") {
  const Scene scene = read_scene_text(least_scene, "least.toml").scene;
  CHECK(scene.title.empty());
  CHECK(scene.gravity == Vector3{});
  CHECK(scene.populations.empty());
  CHECK_FALSE(scene.structure);
  CHECK(scene.excitation.kind == ExcitationKind::none);
  CHECK(scene.time.steps_per_contact == 8.0);
  CHECK_FALSE(scene.time.step);
  CHECK(scene.time.integrator == Integrator::leapfrog);
  CHECK(scene.contact.rotation);
  CHECK_FALSE(scene.contact.wall);
  CHECK(scene.verlet.policy == ListPolicy::guarded);
  CHECK_FALSE(scene.verlet.skin);
  CHECK(scene.verlet.safety == 1.5);
  CHECK(scene.verlet.max_interval == 150);
  CHECK(scene.verlet.interval == 16);
  CHECK(scene.verlet.audit == 0);
  CHECK(scene.output.history_interval == 1e-4);
  CHECK_FALSE(scene.output.window);
  CHECK(scene.output.energy);
}

TEST_CASE("other kinds of scene") {
  SUBCASE("cylinder, prescribed motion, no friction, linear damping, fixed list, material constants") {
    const Scene scene = read_scene_text(R"(
enclosure = {shape = "cylinder", diameter = 0.02, height = 0.03, axis = "x"}
[[granules]]
positions = [[0.01, 0.01, 0.01], [0.02, 0.01, 0.01]]
velocities = [[1, 0, 0], [0, 0, 0]]
spins = [[0, 0, 5], [0, 0, 0]]
radius = 0.001
mass = 2e-5
young = 3e9
poisson = 0.35
[contact]
damping = "linear"
friction = "none"
tension = true
rotation = false
granule = {normal_damping = 0.1}
wall = {normal_damping = 0.2, young = 2e11, poisson = 0.3}
[excitation]
kind = "prescribed"
amplitude = 0.001
frequency = 50
direction = [3, 0, 4]
[time]
duration = 1
step = 1e-6
impact_speed = 2
integrator = "verlet"
precision = "double"
[verlet]
policy = "fixed"
interval = 5
skin = 0.2
cell = 1.5
audit = 100
[output]
energy = false
snapshot_interval = 0
checkpoint_interval = 0
)",
                                        "other.toml")
                            .scene;
    CHECK(scene.enclosure.shape == EnclosureShape::cylinder);
    CHECK(scene.enclosure.axis == 0);
    CHECK(scene.time.precision == Precision::full);
    REQUIRE(scene.populations.size() == 1);
    const Population& granules = scene.populations[0];
    CHECK(granules.placed);
    CHECK(granules.count == 2);
    CHECK(granules.positions[1] == Vector3{0.02, 0.01, 0.01});
    CHECK(granules.velocities[0] == Vector3{1.0, 0.0, 0.0});
    CHECK(granules.spins[0] == Vector3{0.0, 0.0, 5.0});
    CHECK(granules.mass == 2e-5);
    CHECK(granules.young == 3e9);
    CHECK(granules.poisson == 0.35);
    CHECK(scene.contact.damping == NormalDamping::linear);
    CHECK(scene.contact.friction == FrictionLaw::none);
    CHECK_FALSE(scene.contact.rotation);
    CHECK_FALSE(scene.contact.granule.stiffness);
    CHECK(scene.contact.granule.normal_damping == 0.1);
    REQUIRE(scene.contact.wall);
    CHECK(scene.contact.wall->young == 2e11);
    CHECK(scene.excitation.kind == ExcitationKind::prescribed);
    CHECK(scene.excitation.amplitude == 0.001);
    CHECK_FALSE(scene.excitation.velocity);
    CHECK(scene.excitation.direction == Vector3{0.6, 0.0, 0.8});
    CHECK(scene.time.step == 1e-6);
    CHECK(scene.time.impact_speed == 2.0);
    CHECK(scene.time.integrator == Integrator::verlet);
    CHECK(scene.verlet.policy == ListPolicy::fixed);
    CHECK(scene.verlet.interval == 5);
    CHECK(scene.verlet.skin == 0.2);
    CHECK(scene.verlet.cell == 1.5);
    CHECK(scene.verlet.audit == 100);
    CHECK_FALSE(scene.output.energy);
    CHECK(scene.output.checkpoint_interval == 0.0);
  }
  SUBCASE("undamped, and a box at a constant speed") {
    std::string text = replaced(good_scene, "damping = \"tsuji\"", "damping = \"none\"");
    text = replaced(replaced(text, "restitution = 0.89\n", ""), "restitution = 0.9\n", "");
    CHECK(read_scene_text(text, "undamped.toml").scene.contact.damping == NormalDamping::none);
    const Scene moving =
        read_scene_text(least_scene + "excitation = {kind = \"prescribed\", velocity = 3}\n", "moving.toml").scene;
    CHECK(moving.excitation.velocity == 3.0);
    CHECK(moving.excitation.direction == Vector3{1.0, 0.0, 0.0});
  }
  SUBCASE("total_mass is a whole number of granules") {
    const std::string text = replaced(good_scene, "count = 317", "total_mass = 0.010");
    CHECK(read_scene_text(text, "mass.toml").scene.populations[0].count == 317);
  }
  SUBCASE("no granules, though contact and packing stay") {
    const std::string text = replaced(replaced(good_scene, "count = 317", "count = 0"), "-9.81", "0");
    CHECK(read_scene_text(text, "bare.toml").scene.populations[0].count == 0);
  }
}

TEST_CASE("the ready scenes are good, and so is what is written of them") {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path().string());
    ++found;
    const SceneDocument plain = read_scene(entry.path());
    CHECK(plain.notes.empty());
    const SceneDocument changed = read_scene(entry.path(), {"seed=5", "output.history_interval=1e-3"});
    CHECK(changed.scene.seed == 5);
    CHECK_FALSE(same_scene(plain.scene, changed.scene));
    CHECK(same_scene(changed.scene, read_scene_text(changed.text, "again.toml").scene));
    const SceneDocument bare = read_scene(entry.path(), {"granules.0.count=0"});
    CHECK(same_scene(bare.scene, read_scene_text(bare.text, "again.toml").scene));
  }
  CHECK(found >= 5);
}

TEST_CASE("overrides set any key") {
  const std::vector<std::string> overrides{"granules.0.count = 10",
                                           "structure.direction.1=2",
                                           "title=a bare word",
                                           "verlet.policy=predicted",
                                           "verlet.safety=2",
                                           "structure.displacement=1.5e-3",
                                           "seed=3",
                                           "contact.rotation=false",
                                           "structure.direction=[0, 1, 0]"};
  const SceneDocument document = read_scene_text(good_scene, "good.toml", overrides);
  CHECK(document.scene.populations[0].count == 10);
  CHECK(document.scene.title == "a bare word");
  CHECK(document.scene.verlet.policy == ListPolicy::predicted);
  CHECK(document.scene.verlet.safety == 2.0);
  CHECK(document.scene.structure->displacement == 1.5e-3);
  CHECK(document.scene.structure->direction == Vector3{0.0, 1.0, 0.0});
  CHECK_FALSE(document.scene.contact.rotation);
  CHECK(document.notes.empty());
  CHECK(same_scene(document.scene, read_scene_text(document.text, "again.toml").scene));
  CHECK(document.text.find("# --set title=a bare word\n") != std::string::npos);

  const SceneDocument item =
      read_scene_text(good_scene, "good.toml", {"structure.direction.2=0", "structure.direction.0=-3"});
  CHECK(item.scene.structure->direction == Vector3{-1.0, 0.0, 0.0});
  const SceneDocument made = read_scene_text(least_scene, "least.toml", {"structure.mass=1", "structure.stiffness=2"});
  CHECK(made.scene.structure->stiffness == 2.0);
}

TEST_CASE("what an override leaves idle is a note and is gone from the text as run") {
  const auto check = [](const std::vector<std::string>& overrides, const std::vector<std::string>& idle_keys) {
    const SceneDocument document = read_scene_text(good_scene, "good.toml", overrides);
    std::vector<std::string> keys;
    for (const Problem& note : document.notes) {
      CHECK(note.note);
      CHECK(note.line > 0);
      keys.push_back(note.key);
    }
    CAPTURE(format_problems("good.toml", document.notes));
    CHECK(keys == idle_keys);
    const SceneDocument again = read_scene_text(document.text, "again.toml");
    CHECK(again.notes.empty());
    CHECK(same_scene(document.scene, again.scene));
    return document.scene;
  };
  CHECK_FALSE(check({"time.duration=3"}, {"output.window"}).output.window);
  CHECK(check({"granules.0.total_mass=1e-3"}, {"granules.0.count"}).populations[0].count == 32);
  CHECK(check({"time.step=1e-6"}, {"time.steps_per_contact"}).time.step == 1e-6);
  CHECK(check({"contact.wall.alpha=0.05"}, {"contact.wall.restitution"}).contact.wall->alpha == 0.05);
  CHECK(check({"contact.friction=none"}, {"contact.granule.friction", "contact.wall.friction"}).contact.friction ==
        FrictionLaw::none);
  const Scene prescribed =
      check({"excitation.kind=prescribed", "excitation.amplitude=1e-3"}, {"excitation.static_deflection", "structure"});
  CHECK_FALSE(prescribed.structure);
  CHECK(prescribed.excitation.amplitude == 1e-3);
}

TEST_CASE("granules from a file") {
  const Folder folder;
  const std::string scene_text =
      replaced(replaced(good_scene, "count = 317", "file = \"bed.csv\""), "radius = 1.85e-3\n", "");
  SUBCASE("as exports write them: columns in their order, rows in any, ids rule") {
    folder.write("bed.csv", "id,x,y,z,radius,vx,vy,vz,wx,wy,wz\r\n"
                            "1,0.02,0.01,0.01,0.002,0,0,-1e-1,7,8,9\r\n"
                            "0,0.01,0.01,+0.01,0.001,1,2,3,4,5,6\r\n\r\n");
    const std::filesystem::path file = folder.write("scene.toml", scene_text);
    const SceneDocument document = read_scene(file);
    const Population& granules = document.scene.populations[0];
    CHECK(granules.placed);
    CHECK(granules.count == 2);
    CHECK(granules.positions == std::vector<Vector3>{{0.01, 0.01, 0.01}, {0.02, 0.01, 0.01}});
    CHECK(granules.velocities == std::vector<Vector3>{{1, 2, 3}, {0, 0, -0.1}});
    CHECK(granules.spins == std::vector<Vector3>{{4, 5, 6}, {7, 8, 9}});
    CHECK(granules.radii == std::vector<double>{0.001, 0.002});
    REQUIRE(granules.masses.size() == 2);
    CHECK(granules.masses[1] == doctest::Approx(sphere_mass(1190.0, 0.002)).epsilon(1e-14));
    // The text as run finds the granules from wherever it is put.
    const std::filesystem::path moved = folder.write("elsewhere/scene.toml", document.text);
    CHECK(same_scene(document.scene, read_scene(moved).scene));
  }
  SUBCASE("columns of its own, and defaults of the population where it has none") {
    folder.write("bed.csv", "\xEF\xBB\xBF z , density, y,x\n0.03,1000,0.02,0.01\n0.03,2000,0.02,0.02\n");
    const std::string text = replaced(replaced(scene_text, "density = 1190", "radius = 1e-3"), "bed.csv", "./bed.csv");
    const Scene scene = read_scene(folder.write("scene.toml", text)).scene;
    CHECK(scene.populations[0].positions[0] == Vector3{0.01, 0.02, 0.03});
    CHECK(scene.populations[0].velocities.empty());
    CHECK(scene.populations[0].radii.empty());
    CHECK(scene.populations[0].radius == 1e-3);
    CHECK(scene.populations[0].masses[1] == doctest::Approx(sphere_mass(2000.0, 1e-3)).epsilon(1e-14));
  }
  SUBCASE("granules of one size and mass are a population of one size") {
    folder.write("bed.csv", "x,y,z,radius\n0.01,0.01,0.01,0.001\n0.02,0.01,0.01,0.001\n");
    const Scene scene = read_scene(folder.write("scene.toml", scene_text)).scene;
    CHECK(scene.populations[0].radii.empty());
    CHECK(scene.populations[0].masses.empty());
    CHECK(scene.populations[0].radius == 0.001);
  }
  SUBCASE("faults name the file, its line and the scene's line") {
    const auto message_of = [&](const std::string& csv) {
      folder.write("bed.csv", csv);
      try {
        read_scene(folder.write("scene.toml", scene_text));
      } catch (const SceneError& error) {
        return format_problems("scene.toml", error.problems());
      }
      return std::string("(no error)");
    };
    const auto says = [&](const std::string& csv, const std::string& part) {
      const std::string message = message_of(csv);
      CAPTURE(message);
      CHECK(message.find("scene.toml:9: granules.0.file = 'bed.csv': ") != std::string::npos);
      CHECK(message.find("bed.csv, " + part) != std::string::npos);
    };
    says("x,y,z,radius\n1,2,3,1e-3\n1,2,three,1e-3\n", "line 3: z = 'three': not a finite number");
    says("x,y,z,radius\n1,2,inf,1e-3\n", "line 2: z = 'inf': not a finite number");
    says("x,y,z,radius\n1,2,3\n", "line 2: 3 fields where the header has 4");
    says("x,y,z,radius\n1,2,3,4,5\n", "line 2: more fields than the 4 of the header");
    says("x,y,z,radius\n1,2,3,0\n", "line 2: radius = 0: out of range; allowed: above 0");
    says("x,y,z,raduis\n1,2,3,1\n", "line 1: unknown column 'raduis' (perhaps 'radius')");
    says("x,y,radius\n1,2,3\n", "line 1: no column 'z'");
    says("x,y,z,x\n1,2,3,1\n", "line 1: column 'x' twice");
    says("id,x,y,z,radius\n0,1,2,3,1\n0,1,2,3,1\n", "line 3: id 0 again, first on line 2");
    says("id,x,y,z,radius\n-1,1,2,3,1\n", "line 2: id = '-1': not a whole number from 0");
    says("x,y,z,radius\n", "line 1: no granules below the header");
    says("", "line 1: unknown column ''");
    CHECK(message_of("x,y,z,density,radius\n0.01,0.01,0.01,1000,1e-3\n")
              .find("granules.0.density = 1190: does not apply") != std::string::npos);
  }
  SUBCASE("a file given by an override replaces the count") {
    const std::filesystem::path csv = folder.write("other bed.csv", "x,y,z\n0.01,0.01,0.01\n");
    const SceneDocument document = read_scene_text(good_scene, "good.toml", {"granules.0.file=" + csv.string()});
    CHECK(document.scene.populations[0].count == 1);
    CHECK(document.scene.populations[0].placed);
    REQUIRE(document.notes.size() == 1);
    CHECK(document.notes[0].key == "granules.0.count");
  }
}

TEST_CASE("the line of a key, for faults found later") {
  const SceneDocument document = read_scene_text(good_scene, "good.toml");
  CHECK(line_of(document, "granules.0.radius") == 10);
  CHECK(line_of(document, "granules.0.young") == 7); // absent: its table's
  CHECK(line_of(document, "structure.direction.2") == 31);
  CHECK(line_of(document, "contact.wall") == 22);
  CHECK(line_of(document, "packing") == 12);
  CHECK(line_of(document, "nonsense") == 0);
  const std::vector<Problem> problems = located(document, {Problem{"granules.0.radius", "0.00185", "too big", "less"}});
  CHECK(format_problems("good.toml", problems) ==
        "good.toml:10: granules.0.radius = 0.00185: too big; allowed: less\n");
  const SceneDocument changed = read_scene_text(good_scene, "good.toml", {"granules.0.radius=1e-3"});
  CHECK(line_of(changed, "granules.0.radius") == 0);
}

TEST_CASE("files that cannot be read") {
  CHECK_THROWS_AS(read_scene("/no/such/scene.toml"), FileError);
  CHECK_THROWS_AS(read_scene(std::filesystem::temp_directory_path()), FileError);
}

TEST_CASE("contacts between two populations and with the wall") {
  const std::string steel = R"([[granules]]
name = "steel"
count = 20
radius = 2e-3
density = 7800
[packing])";
  std::string text = replaced(good_scene, "[packing]", steel);
  const std::string pairs = R"([[contact.pair]]
between = ["acrylic", "steel"]
stiffness = 2e7
reference_radius = 3e-3
restitution = 0.7
friction = 0.3
[[contact.pair]]
between = ["wall", "steel"]
young = 2e11
poisson = 0.3
alpha = 0.2
friction = 0.1
)";
  text = replaced(text, "radius = 2e-3\n", "radius = 2e-3\nyoung = 2.1e11\npoisson = 0.29\n");
  text = replaced(text, "[structure]", pairs + "[structure]");
  const Scene scene = read_scene_text(text, "pairs.toml").scene;
  REQUIRE(scene.contact.pairs.size() == 2);
  CHECK(scene.contact.pairs[0].between == std::array<std::string, 2>{"acrylic", "steel"});
  CHECK(scene.contact.pairs[0].constants.stiffness == 2e7);
  CHECK(scene.contact.pairs[0].constants.restitution == 0.7);
  CHECK(scene.contact.pairs[0].constants.friction == 0.3);
  CHECK(scene.contact.pairs[1].between == std::array<std::string, 2>{"wall", "steel"});
  CHECK(scene.contact.pairs[1].constants.young == 2e11);
  CHECK(scene.contact.pairs[1].constants.alpha == 0.2);
  // As run with an override, and read again: the same.
  const SceneDocument changed = read_scene_text(text, "pairs.toml", {"contact.pair.0.friction=0.4"});
  CHECK(changed.scene.contact.pairs[0].constants.friction == 0.4);
  CHECK(test::same_scene(read_scene_text(changed.text, "again.toml").scene, changed.scene));

  // Pairs that say everything need no [contact.granule].
  std::string whole =
      replaced(good_scene, "[contact.granule]", "[[contact.pair]]\nbetween = [\"acrylic\", \"acrylic\"]");
  CHECK(read_scene_text(whole, "whole.toml").scene.contact.pairs.size() == 1);
}
