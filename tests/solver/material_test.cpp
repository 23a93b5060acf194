// The constants of contacts, from what a scene gives.
#include "solver/errors.hpp"
#include "solver/material.hpp"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace grandamp;

namespace {

Population population(double radius, double young, double poisson) {
  Population p;
  p.count = 3;
  p.radius = radius;
  p.mass = 1.0e-5;
  p.young = young;
  p.poisson = poisson;
  return p;
}

Contact losses() {
  Contact contact;
  contact.granule.restitution = 0.9;
  contact.granule.friction = 0.5;
  return contact;
}

std::vector<std::string> missing(const Scene& scene) {
  std::vector<std::string> keys;
  try {
    make_contact_table(scene);
  } catch (const SceneError& error) {
    for (const Problem& problem : error.problems()) keys.push_back(problem.key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

} // namespace

TEST_CASE("alpha of a restitution and its values in the paper") {
  CHECK(tsuji_alpha(1.0) == 0.0);
  CHECK_FALSE(std::signbit(tsuji_alpha(1.0)));
  CHECK(tsuji_alpha(0.89) == doctest::Approx(0.0829).epsilon(1e-3));
  CHECK(tsuji_alpha(0.8974) == doctest::Approx(0.077).epsilon(1e-3));
  CHECK(tsuji_alpha(1e-300) < std::sqrt(5.0));
  for (const double bad : {0.0, -0.1, 1.0001, std::nan("")}) CHECK_THROWS_AS(tsuji_alpha(bad), SceneError);
}

TEST_CASE("alpha gives its restitution in the damped Hertz contact") {
  // d'' = -d^1.5 - alpha d^0.25 d' with unit mass and stiffness: the rebound's speed against the impact's.
  for (const double e : {0.05, 0.3, 0.5, 0.89, 1.0}) {
    const double alpha = tsuji_alpha(e), dt = 2.0e-5;
    double x = 0.0, v = 1.0;
    const auto force = [&](double at, double speed) {
      return -std::pow(std::max(at, 0.0), 1.5) - alpha * std::pow(std::max(at, 0.0), 0.25) * speed;
    };
    for (;;) {
      const double v1 = v + 0.5 * dt * force(x, v), x1 = x + 0.5 * dt * v;
      const double v2 = v + dt * force(x1, v1), x2 = x + dt * v1;
      x = x2;
      v = v2;
      if (x <= 0.0) break;
    }
    CHECK(-v == doctest::Approx(e).epsilon(1e-3));
  }
}

TEST_CASE("a given stiffness holds for its reference radius and scales with the root of the radius") {
  Scene scene;
  scene.populations = {population(1.5e-3, 1.0, 0.0), population(6.0e-3, 1.0, 0.0)};
  scene.contact = losses();
  scene.contact.granule.stiffness = 1.0e7;
  scene.contact.granule.reference_radius = 3.0e-3;
  scene.contact.wall = scene.contact.granule;
  scene.contact.wall->stiffness = 1.3e7;
  const ContactTable table = make_contact_table(scene);
  const auto pair = [&](double a, double b) {
    return table.between(0, 1).stiffness_coefficient * std::sqrt(a * b / (a + b));
  };
  CHECK(pair(3.0e-3, 3.0e-3) == doctest::Approx(1.0e7).epsilon(1e-14));
  CHECK(pair(1.5e-3, 1.5e-3) == doctest::Approx(1.0e7 * std::sqrt(0.5)).epsilon(1e-14));
  CHECK(pair(1.5e-3, 6.0e-3) == doctest::Approx(1.0e7 * std::sqrt(2.0 * 1.2e-3 / 3.0e-3)).epsilon(1e-14));
  CHECK(table.wall[0].stiffness_coefficient * std::sqrt(1.5e-3) ==
        doctest::Approx(1.3e7 * std::sqrt(0.5)).epsilon(1e-14));
  CHECK(table.wall[0].alpha == tsuji_alpha(0.9));
  // Left out: the flat wall of the same material is sqrt(2) stiffer than a pair of equals.
  scene.contact.wall.reset();
  const ContactTable same = make_contact_table(scene);
  CHECK(same.wall[1].stiffness_coefficient == same.between(1, 1).stiffness_coefficient);
  CHECK(same.wall[1] == same.between(1, 1));
}

TEST_CASE("Hertz from moduli - equals unlikes and a rigid partner by the corrected equation") {
  Scene scene;
  scene.populations = {population(1.0e-3, 3.0e9, 0.35), population(1.0e-3, 2.0e11, 0.3)};
  scene.contact = losses();
  ContactTable table = make_contact_table(scene);
  CHECK(table.between(0, 0).stiffness_coefficient ==
        doctest::Approx(4.0 / 3.0 * 3.0e9 / (2.0 * (1.0 - 0.35 * 0.35))).epsilon(1e-14));
  const double ei = 3.0e9, ej = 2.0e11, ni = 0.35, nj = 0.3;
  CHECK(table.between(0, 1).stiffness_coefficient ==
        doctest::Approx(4.0 / 3.0 * ei * ej / ((1 - ni * ni) * ej + (1 - nj * nj) * ei)).epsilon(1e-14));
  CHECK(table.between(0, 1) == table.between(1, 0));
  CHECK(table.wall[0] == table.between(0, 0));
  scene.contact.wall = scene.contact.granule;
  scene.contact.wall->young = 1.0e30; // rigid
  scene.contact.wall->poisson = 0.1;
  table = make_contact_table(scene);
  CHECK(table.wall[0].stiffness_coefficient == doctest::Approx(4.0 / 3.0 * 3.0e9 / (1.0 - 0.35 * 0.35)).epsilon(1e-12));
}

TEST_CASE("constants that are missing or out of range are named all at once") {
  Scene scene;
  scene.populations = {population(1.0e-3, 1.0e9, 0.3)};
  scene.populations[0].young.reset();
  scene.populations[0].poisson.reset();
  CHECK(missing(scene) == std::vector<std::string>{"contact.granule.friction", "contact.granule.restitution",
                                                   "granules.0.poisson", "granules.0.young"});
  scene.contact = losses();
  scene.contact.granule.stiffness = 1.0e7;
  CHECK(missing(scene) == std::vector<std::string>{"contact.granule.reference_radius"});
  scene.contact.granule.reference_radius = 1.0e-3;
  CHECK(missing(scene).empty());
  scene.contact.wall = ContactConstants{};
  CHECK(missing(scene) == std::vector<std::string>{"contact.wall.friction", "contact.wall.poisson",
                                                   "contact.wall.restitution", "contact.wall.young",
                                                   "granules.0.poisson", "granules.0.young"});
  scene.contact.wall.reset();
  scene.contact.granule.restitution = 1.2;
  CHECK(missing(scene) == std::vector<std::string>{"contact.granule.restitution"});
  scene.contact.damping = NormalDamping::linear;
  CHECK(missing(scene) == std::vector<std::string>{"contact.granule.normal_damping"});
  scene.contact.damping = NormalDamping::none;
  scene.contact.friction = FrictionLaw::none;
  scene.contact.granule.friction.reset();
  CHECK(missing(scene).empty());
  scene.populations.clear();
  scene.contact = Contact{};
  CHECK(missing(scene).empty()); // the bare structure needs none
}

TEST_CASE("pairs of populations and a population with the wall have constants of their own") {
  Scene scene;
  scene.populations = {population(1.0e-3, 3.0e9, 0.35), population(2.0e-3, 2.0e11, 0.3)};
  scene.populations[0].name = "acrylic";
  scene.populations[1].name = "steel";
  scene.contact = losses();
  const ContactTable plain = make_contact_table(scene);
  ContactConstants own;
  own.restitution = 0.6;
  own.friction = 0.1;
  scene.contact.pairs.push_back({{"steel", "acrylic"}, own});
  own.stiffness = 2.0e7;
  own.reference_radius = 4.0e-3;
  own.friction = 0.2;
  scene.contact.pairs.push_back({{"wall", "steel"}, own});
  const ContactTable table = make_contact_table(scene);
  CHECK(table.between(0, 0) == plain.between(0, 0));
  CHECK(table.between(1, 1) == plain.between(1, 1));
  CHECK(table.wall[0] == plain.wall[0]);
  CHECK(table.between(0, 1) == table.between(1, 0));
  CHECK(table.between(0, 1).stiffness_coefficient == plain.between(0, 1).stiffness_coefficient);
  CHECK(table.between(0, 1).alpha == tsuji_alpha(0.6));
  CHECK(table.between(0, 1).friction == 0.1);
  CHECK(table.wall[1].stiffness_coefficient * std::sqrt(4.0e-3) == doctest::Approx(2.0e7).epsilon(1e-14));
  CHECK(table.wall[1].friction == 0.2);

  // A wall's material, for one of the two.
  scene.contact.pairs[1].constants.stiffness.reset();
  CHECK(missing(scene) == std::vector<std::string>{"contact.pair.1.poisson", "contact.pair.1.young"});
  scene.contact.pairs[1].constants.young = 1.0e30;
  scene.contact.pairs[1].constants.poisson = 0.0;
  CHECK(make_contact_table(scene).wall[1].stiffness_coefficient ==
        doctest::Approx(4.0 / 3.0 * 2.0e11 / (1.0 - 0.09)).epsilon(1e-12));

  scene.contact.pairs.push_back({{"acrylic", "steel"}, own});
  scene.contact.pairs.push_back({{"acrylic", "glass"}, own});
  scene.contact.pairs.push_back({{"wall", "wall"}, own});
  scene.contact.pairs.push_back({{"", "wall"}, own});
  scene.populations.push_back(population(1.0e-3, 1.0e9, 0.3));
  CHECK(missing(scene) == std::vector<std::string>{"contact.pair.2.between", "contact.pair.3.between",
                                                   "contact.pair.4.between", "contact.pair.5.between"});
}

TEST_CASE("alpha without tension gives its restitution where the force ends") {
  CHECK(tsuji_alpha_without_tension(1.0) == 0.0);
  for (const double bad : {0.0, -0.1, 1.0001, std::nan("")})
    CHECK_THROWS_AS(tsuji_alpha_without_tension(bad), SceneError);
  for (const double e : {0.05, 0.1, 0.135, 0.136, 0.3, 0.5, 0.89, 0.99}) {
    // d'' = -d^1.5 - alpha d^0.25 d' with unit mass and stiffness, until it would pull.
    const double alpha = tsuji_alpha_without_tension(e), dt = 2.0e-4;
    double x = 0.0, v = 1.0;
    const auto force = [&](double at, double speed) {
      return -std::pow(std::max(at, 0.0), 1.5) - alpha * std::pow(std::max(at, 0.0), 0.25) * speed;
    };
    for (int n = 0; n < 10 || force(x, v) < 0.0; ++n) {
      const double v1 = v + 0.5 * dt * force(x, v), x1 = x + 0.5 * dt * v;
      v += dt * force(x1, v1);
      x += dt * v1;
    }
    CHECK(-v == doctest::Approx(e).epsilon(1e-3));
  }
}

TEST_CASE("tangential stiffness scales with the radii as the stiffness does and is Mindlin's where moduli are given") {
  Scene scene;
  scene.populations = {population(1.5e-3, 3.0e9, 0.35), population(6.0e-3, 2.0e11, 0.3)};
  scene.contact = losses();
  scene.contact.friction = FrictionLaw::spring;
  const ContactTable mindlin = make_contact_table(scene);
  const auto shear = [](double young, double poisson) { return young / (2.0 * (1.0 + poisson)); };
  CHECK(mindlin.between(0, 1).tangential_stiffness_coefficient ==
        doctest::Approx(8.0 / (1.65 / shear(3.0e9, 0.35) + 1.7 / shear(2.0e11, 0.3))).epsilon(1e-14));
  CHECK(mindlin.wall[0].tangential_stiffness_coefficient == mindlin.between(0, 0).tangential_stiffness_coefficient);

  scene.contact.granule.stiffness = 1.0e7;
  scene.contact.granule.reference_radius = 3.0e-3;
  CHECK(missing(scene) == std::vector<std::string>{"contact.granule.tangential_stiffness"});
  scene.contact.granule.tangential_stiffness = 4.0e6;
  scene.contact.granule.tangential_damping = 0.01;
  scene.contact.wall = scene.contact.granule;
  const ContactTable table = make_contact_table(scene);
  CHECK(table.between(0, 1).tangential_stiffness_coefficient ==
        doctest::Approx(0.4 * table.between(0, 1).stiffness_coefficient).epsilon(1e-14));
  CHECK(table.wall[1].tangential_stiffness_coefficient ==
        doctest::Approx(0.4 * table.wall[1].stiffness_coefficient).epsilon(1e-14));
  CHECK(table.between(1, 1).tangential_damping == 0.01);
}
