// What --vary, --over and --keep total_mass make of their text.
#include "io/design_space.hpp"
#include "io/kept_mass.hpp"
#include "io/run.hpp"
#include "io/vary.hpp"
#include "tests/io/io_support.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace grandamp;
using namespace grandamp::test;

namespace {

std::vector<std::string> texts_of(const VariedKey& key) {
  std::vector<std::string> texts;
  for (const VaryValue& value : key.values) texts.push_back(value.text);
  return texts;
}

template <class Work> std::string refusal(const Work& work) {
  try {
    work();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

/// Total mass under overrides, kg.
double mass_under(const std::vector<std::string>& overrides) {
  const Scene scene = read_scene_text(small_scene(), "small.toml", overrides).scene;
  return static_cast<double>(scene.populations[0].count) * scene.populations[0].mass;
}

} // namespace

TEST_CASE("vary: ranges, ranges by factors, lists, whole numbers") {
  CHECK(texts_of(parse_vary("excitation.frequency=15.5:16.5:6")) ==
        std::vector<std::string>{"15.5", "15.7", "15.9", "16.1", "16.3", "16.5"});
  CHECK(texts_of(parse_vary("excitation.force=0.01:100:5:log")) ==
        std::vector<std::string>{"0.01", "0.1", "1.0", "10.0", "100.0"});
  CHECK(texts_of(parse_vary("granules.0.count=100:200:4")) == std::vector<std::string>{"100", "133", "167", "200"});
  CHECK(texts_of(parse_vary("contact.friction=coulomb, none")) == std::vector<std::string>{"coulomb", "none"});
  CHECK(texts_of(parse_vary("gravity=[0, 0, -9.81],[0, 0, -1]")) ==
        std::vector<std::string>{"[0, 0, -9.81]", "[0, 0, -1]"});
  CHECK(texts_of(parse_vary("structure.mass=2")) == std::vector<std::string>{"2.0"});
  const VariedKey down = parse_vary("structure.mass=2:1:3");
  CHECK(texts_of(down) == std::vector<std::string>{"2.0", "1.5", "1.0"});
  CHECK(down.numeric());
  CHECK_FALSE(parse_vary("contact.friction=coulomb,none").numeric());
}

TEST_CASE("vary: the grid has the last key the fastest") {
  const auto points = grid_points(parse_vary({"structure.mass=1,2", "contact.friction=coulomb,none,spring"}, {}, 1));
  REQUIRE(points.size() == 6);
  CHECK(points[1][0].text == "1.0");
  CHECK(points[1][1].text == "none");
  CHECK(points[5][0].text == "2.0");
}

TEST_CASE("vary: what is no grid is refused, with what is allowed") {
  for (const char* bad : {"a",
                          "=1",
                          "a=",
                          "a=1:2",
                          "a=1:2:3:4",
                          "a=1:2:3:4:5",
                          "a=x:2:3",
                          "a=1:x:3",
                          "a=1:2:0",
                          "a=1:2:-1",
                          "a=1:2:2.5",
                          "a=1:2:1",
                          "a=1:1:3",
                          "a=0:1:3:log",
                          "a=-1:1:3:log",
                          "a=1,,2",
                          "a=1,1.0",
                          "granules.0.count=1.5",
                          "seed=1,2",
                          "granules.0.count=1:2:3",
                          "a=1:2:1000000",
                          "a=1:2:3,4",
                          "a=inf:1:2",
                          "a=0x1:2:3"}) {
    CAPTURE(bad);
    const std::string message = refusal([bad] { parse_vary({bad}, {}, 1); });
    CHECK(contains(message, "--vary " + std::string(bad) + ": "));
    CHECK(contains(message, "; allowed: "));
  }
  CHECK(contains(refusal([] { parse_vary({"a=1,2", "a=3,4"}, {}, 1); }), "varied twice"));
  CHECK(contains(refusal([] { parse_vary({"a=1,2"}, {"a = 3"}, 1); }), "--set a = 3 gives the same key"));
  CHECK(contains(refusal([] { parse_vary({"a=1:2:1000", "b=1:2:1000"}, {}, 1); }), "at most 100000"));
  CHECK(contains(refusal([] { parse_vary({"a=1:2:1000"}, {}, 1000); }), "at most 100000"));
  CHECK(contains(refusal([] { parse_vary({}, {}, 1); }), "--vary"));
}

TEST_CASE("keep total_mass: the mass stays to rounding, whatever is varied") {
  const SceneDocument document = read_scene_text(small_scene(), "small.toml");
  const double total = mass_under({});
  CHECK(total == doctest::Approx(8.0 * 1190.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(1.5e-3, 3)).epsilon(1e-14));
  const std::vector<std::vector<std::string>> varied{{"radius=1.2e-3", "radius=1.31e-3", "radius=2.2e-3"},
                                                     {"density=900.0", "density=2700.0"},
                                                     {"mass=1.0e-5", "mass=3.3e-5"},
                                                     {"count=3", "count=5", "count=21"}};
  for (const std::vector<std::string>& values : varied)
    for (const std::string& one : values) {
      CAPTURE(one);
      const std::string key = "granules.0." + one.substr(0, one.find('='));
      const std::string value = one.substr(one.find('=') + 1);
      const KeptMass kept(document, {key});
      std::vector<std::string> overrides{"granules.0." + one};
      for (const std::string& other : kept.overrides({{value, std::stod(value)}})) overrides.push_back(other);
      CHECK(std::abs(mass_under(overrides) / total - 1.0) < 4e-16 * 4.0);
      // What follows is the count or the radius; the density of a granule moves by less than a granule's share.
      const Population population = read_scene_text(small_scene(), "small.toml", overrides).scene.populations[0];
      const double density = population.mass / (4.0 / 3.0 * std::numbers::pi * std::pow(population.radius, 3));
      const double asked = key == "granules.0.density" ? std::stod(value) : 1190.0;
      if (key != "granules.0.mass")
        CHECK(std::abs(density / asked - 1.0) <= 0.5 / (static_cast<double>(population.count) - 0.5));
      if (key == "granules.0.count") CHECK(std::abs(density / 1190.0 - 1.0) < 1e-14);
    }
  const KeptMass both(document, {"granules.0.count", "granules.0.radius"});
  std::vector<std::string> overrides{"granules.0.count=4", "granules.0.radius=2.0e-3"};
  for (const std::string& one : both.overrides({{"4", 4.0}, {"2.0e-3", 2.0e-3}})) overrides.push_back(one);
  CHECK(std::abs(mass_under(overrides) / total - 1.0) < 2e-15);
}

TEST_CASE("keep total_mass: what cannot be kept is refused") {
  const SceneDocument document = read_scene_text(small_scene(), "small.toml");
  const auto refused = [&](const std::vector<std::string>& keys) { return refusal([&] { KeptMass(document, keys); }); };
  CHECK(contains(refused({"structure.mass"}), "nothing that is varied changes"));
  CHECK(contains(refused({"granules.0.total_mass", "granules.0.radius"}), "is varied itself"));
  CHECK(contains(refused({"granules.0.count", "granules.0.radius", "granules.0.density"}), "nothing is left"));
  const KeptMass kept(document, {"granules.0.radius"});
  CHECK(contains(refusal([&] { kept.overrides({{"-1", -1.0}}); }), "not above 0"));
  CHECK(contains(refusal([&] { kept.overrides({{"0.1", 0.1}}); }), "from 1 to"));
  const SceneDocument bare = read_scene_text(small_scene(), "small.toml", {"granules.0.count=0"});
  CHECK(contains(refusal([&] { KeptMass(bare, {"granules.0.radius"}); }), "no granules"));
}

TEST_CASE("over: bounds, factors, whole numbers, and what is refused") {
  const FreeKey radius = parse_over("granules.0.radius=1e-3:3e-3");
  CHECK(radius.at(0.0) == 1e-3);
  CHECK(radius.at(1.0) == 3e-3);
  CHECK(radius.at(0.5) == doctest::Approx(2e-3).epsilon(1e-15));
  CHECK(radius.share_of(2e-3) == doctest::Approx(0.5));
  const FreeKey force = parse_over("excitation.force=0.01:1:log");
  CHECK(force.at(0.5) == doctest::Approx(0.1));
  CHECK(force.share_of(0.1) == doctest::Approx(0.5));
  CHECK(values_at({parse_over("granules.0.count=2.5:9.5")}, {0.0})[0].text == "3");
  CHECK(values_at({parse_over("granules.0.count=2.5:9.5")}, {0.4})[0].text == "5");
  for (const char* bad : {"a", "=1:2", "a=1", "a=1:2:3", "a=x:2", "a=1:", "a=2:1", "a=1:1", "a=0:1:log", "seed=1:9",
                          "granules.0.count=1.2:1.8", "a=nan:1"}) {
    CAPTURE(bad);
    CHECK(contains(refusal([bad] { parse_over(std::vector<std::string>{bad}, {}); }), "; allowed: "));
  }
  CHECK(contains(refusal([] { parse_over({"a=1:2", "a=1:3"}, {}); }), "comes twice"));
  CHECK(contains(refusal([] { parse_over({"a=1:2"}, {"a=3"}); }), "--set a=3"));
  CHECK(number_in(small_scene(), "granules.0.radius") == 1.5e-3);
  CHECK_FALSE(number_in(small_scene(), "granules.1.radius"));
  CHECK_FALSE(number_in(small_scene(), "granules.0.name"));
}
