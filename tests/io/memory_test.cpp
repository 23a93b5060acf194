// What `check` tells of a run's memory, held against what the run takes.
// A sanitizer's own memory is many times the program's.
#ifndef __SANITIZE_ADDRESS__

#include "tests/io/io_support.hpp"
#include "tests/support/scene_texts.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace grandamp::test;

namespace {

/// The largest resident set of the program under `arguments`, bytes. By way of another process, since one that is
/// forked begins with what its parent held.
double largest_memory(const TemporaryFolder& folder, const std::string& arguments) {
  const Outcome told = shell(folder, "/usr/bin/python3 -c 'import resource, subprocess, sys\n"
                                     "subprocess.run(sys.argv[1:], check=True)\n"
                                     "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' " +
                                         std::string(GRANDAMP_PROGRAM) + " " + arguments);
  INFO(told.errors);
  REQUIRE(told.status == 0);
  return 1024.0 * std::stod(told.output);
}

/// A cubic lattice with gaps, `side` granules along each edge, at small random speeds; every eighth granule of another
/// size if asked.
std::string lattice(int side, bool sizes) {
  std::string text = sizes ? "x,y,z,vx,vy,vz,radius\n" : "x,y,z,vx,vy,vz\n";
  for (int i = 0; i < side * side * side; ++i) {
    const int cells[3]{i % side, i / side % side, i / (side * side)};
    for (const int cell : cells) text += std::to_string(0.005 * (cell + 0.5)) + ",";
    text += std::to_string(0.01 * (i % 7 - 3)) + "," + std::to_string(0.01 * (i % 11 - 5)) + ",0";
    if (sizes) text += i % 8 == 0 ? ",0.0023" : ",0.0016";
    text += "\n";
  }
  return text;
}

/// The good scene with that lattice in place of its granules, for 25 steps; that of two sizes without friction.
std::string bed(bool sizes) {
  std::string text = replaced(good_scene, "count = 317\nradius = 1.85e-3\n",
                              std::string("file = \"bed.csv\"\n") + (sizes ? "" : "radius = 2.3e-3\n"));
  text = replaced(text, "[packing]\nkind = \"settled\"\n", "");
  text = replaced(text, "[0.025, 0.025, 0.0359]", "[0.3, 0.3, 0.3]");
  text =
      replaced(text, "duration = 7.0\nsteps_per_contact = 8", "duration = 1.0e-4\nstep = 4.0e-6\nimpact_speed = 1.0");
  text = replaced(text, "window = [3.5, 7.0]\n", "");
  return sizes ? replaced(replaced(text, "friction = 0.52\n", ""), "friction = 0.5\n", "") : text;
}

} // namespace

TEST_CASE("check's memory is what a run takes at its most, within a fifth") {
  struct Kind {
    std::string name;
    int side; ///< of the lattice, granules
    bool sizes;
    std::vector<std::string> overrides;
  };
  const std::vector<std::string> springs{"contact.friction=\"spring\"", "contact.granule.tangential_stiffness=8.0e6",
                                         "contact.wall.tangential_stiffness=8.0e6"};
  std::vector<std::string> in_a_high_box = springs;
  in_a_high_box.emplace_back("enclosure.size=[0.3,0.3,6.0]");
  const std::vector<Kind> kinds{
      {"as it is", 60, false, {}},
      {"no ledger", 60, false, {"output.energy=false"}},
      {"fewer", 38, false, {"output.energy=false", "enclosure.size=[0.19,0.19,0.19]"}},
      {"springs", 60, false, springs},
      {"springs, in a high box", 60, false, in_a_high_box},
      {"verlet", 60, false, {"time.integrator=\"verlet\""}},
      {"two sizes, no friction", 60, true, {"contact.friction=\"none\"", "output.energy=false"}}};
  for (const Kind& kind : kinds) {
    const TemporaryFolder folder;
    write_content(folder / "bed.toml", bed(kind.sizes));
    write_content(folder / "bed.csv", lattice(kind.side, kind.sizes));
    std::string changes;
    for (const std::string& change : kind.overrides) changes += " --set '" + change + "'";
    const Outcome check = program(folder, "check bed.toml --json" + changes);
    INFO(kind.name, ": ", check.errors);
    REQUIRE(check.status == 0);
    const auto memory = nlohmann::json::parse(check.output)["memory"].get<double>();
    const double taken = largest_memory(folder, "run bed.toml --quiet --threads 1" + changes);
    MESSAGE(kind.name, ": ", 1.0e-6 * memory, " MB told, ", 1.0e-6 * taken, " MB taken");
    CHECK(memory == doctest::Approx(taken).epsilon(0.2));
  }
}
#endif
