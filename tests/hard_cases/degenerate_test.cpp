// Normals that hang by a thread: columns, corners, a cylinder's axis; and starts that cannot be.
#include "tests/hard_cases/watch.hpp"
#include "tests/support/scenes.hpp"

#include "solver/errors.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double radius = 1.5e-3;

/// 50 granules, one upon the other in the middle of a shaft.
Scene column() {
  Scene scene = box_scene(0.01, radius);
  scene.enclosure.size = {0.01, 0.01, 0.16};
  scene.gravity = {0.0, 0.0, -9.81};
  for (int n = 0; n < 50; ++n) add_granule(scene, {0.005, 0.005, radius + 2.0 * radius * n});
  scene.time.duration = full_tests() ? 0.5 : 0.05;
  return scene;
}

/// One granule that gravity presses into a corner of the box.
Scene cornered() {
  Scene scene = box_scene(0.01, radius);
  scene.gravity = {-5.0, -5.0, -5.0};
  add_granule(scene, {radius, radius, radius});
  scene.time.duration = full_tests() ? 1.0 : 0.1;
  return scene;
}

/// Two granules upright on a cylinder's axis.
Scene on_axis() {
  Scene scene = box_scene(0.01, radius);
  scene.enclosure.shape = EnclosureShape::cylinder;
  scene.enclosure.diameter = 0.01;
  scene.enclosure.height = 0.02;
  scene.gravity = {0.0, 0.0, -9.81};
  add_granule(scene, {0.005, 0.005, radius});
  add_granule(scene, {0.005, 0.005, 3.0 * radius});
  scene.time.duration = full_tests() ? 1.0 : 0.1;
  return scene;
}

/// A granule exactly as wide as the cylinder that it stands in: the side touches all round, and nowhere.
Scene plugged() {
  Scene scene = on_axis();
  scene.enclosure.diameter = 2.0 * radius;
  for (Vector3& p : scene.populations[0].positions) p[0] = p[1] = radius;
  return scene;
}

template <class Symmetric> void run_case(const char* name, Scene (*make)(), const Symmetric& symmetric) {
  CaseReport report(name);
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    bool always = true;
    WatchOptions options;
    options.on_look = [&](const GranuleTable& granules, const Sample&) { always = always && symmetric(granules); };
    report.add(choice, watch(make(), choice, options));
    CHECK(always);
  }
}

bool upright(const GranuleTable& granules, double x, double y) {
  for (std::size_t i = 0; i < granules.position.size(); ++i) {
    if (granules.position[i][0] != x || granules.position[i][1] != y) return false;
    if (granules.velocity[i][0] != 0.0 || granules.velocity[i][1] != 0.0) return false;
    if (length(granules.spin[i]) != 0.0) return false;
  }
  return true;
}

/// All faults of a scene that must be refused, in one text.
std::string refusal(Scene scene) {
  scene.time.duration = 1.0e-3;
  try {
    Simulation simulation(scene);
  } catch (const SceneError& error) {
    std::string text;
    for (const Problem& problem : error.problems()) text += problem.key + ": " + problem.message + "\n";
    return text;
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("hard cases: a column of 50 granules stays upright to the last bit") {
  run_case("column of 50", column, [](const GranuleTable& now) { return upright(now, 0.005, 0.005); });
}

TEST_CASE("hard cases: two granules on a cylinder's axis, and a plug as wide as the cylinder") {
  run_case("on the axis", on_axis, [](const GranuleTable& now) { return upright(now, 0.005, 0.005); });
  run_case("plug", plugged, [](const GranuleTable& now) { return upright(now, radius, radius); });
}

TEST_CASE("hard cases: a granule in a corner keeps the corner's symmetry") {
  run_case("cornered", cornered, [](const GranuleTable& now) {
    const Vector3 &p = now.position[0], &v = now.velocity[0], &w = now.spin[0];
    const double off = std::abs(p[0] - p[1]) + std::abs(p[1] - p[2]);
    return off <= 1.0e-12 * radius && std::abs(v[0] - v[1]) + std::abs(v[1] - v[2]) < 1.0e-12 && length(w) < 1.0e-9;
  });
}

TEST_CASE("hard cases: starts that cannot be are refused, with the granules named") {
  Scene one_centre = box_scene(0.02, radius);
  add_granule(one_centre, {0.005, 0.01, 0.01});
  add_granule(one_centre, {0.01, 0.01, 0.01});
  add_granule(one_centre, {0.01, 0.01, 0.01});
  CAPTURE(refusal(one_centre));
  CHECK(contains(refusal(one_centre), "granules 1 and 2 have one centre"));

  Scene deep = box_scene(0.02, radius);
  add_granule(deep, {0.01, 0.01, 0.01});
  add_granule(deep, {0.01, 0.01 + 1.5 * radius, 0.01});
  CAPTURE(refusal(deep));
  CHECK(contains(refusal(deep), "granules 0 and 1 overlap by 0.5 of the smaller radius"));

  Scene across = box_scene(0.02, radius);
  add_granule(across, {0.01, 0.01, 0.5 * radius});
  add_granule(across, {0.01, 0.03, 0.01});
  CAPTURE(refusal(across));
  CHECK(contains(refusal(across), "granule 0 crosses a wall by 0.5 of its radius"));
  CHECK(contains(refusal(across), "granule 1 is outside the enclosure"));

  // Just inside the walls of a cylinder's box, but outside the cylinder.
  Scene rim = on_axis();
  rim.populations[0].positions[0] = {0.0016, 0.0016, 0.01};
  CAPTURE(refusal(rim));
  CHECK(contains(refusal(rim), "granule 0"));

  // A small granule deep in a large one: over the smaller radius.
  Scene swallowed = box_scene(0.04, 10.0e-3);
  add_granule(swallowed, {0.02, 0.02, 0.02});
  add_granule(swallowed, {0.02, 0.02, 0.025});
  swallowed.populations[0].radii = {10.0e-3, 0.5e-3};
  swallowed.populations[0].masses = {1.0e-3, 1.0e-6};
  CHECK(contains(refusal(swallowed), "granules 0 and 1 overlap"));
}

TEST_CASE("hard cases: a packing's own small overlaps push apart, and make no energy") {
  CaseReport report("small overlaps");
  for (const Choice& choice : pairwise_choices()) {
    const std::string settings = told(choice);
    CAPTURE(settings);
    Scene scene = box_scene(0.02, radius);
    add_granule(scene, {0.01, 0.01, 0.01});
    add_granule(scene, {0.01, 0.01 + 1.9 * radius, 0.01});
    add_granule(scene, {0.01, 0.01, 0.95 * radius});
    scene.time.duration = 2.0e-3;
    scene.time.impact_speed = 10.0;
    Bounds bounds;
    bounds.residual = 2.5 * residual_of_a_contact(choice); // all of the energy is elastic at the start
    report.add(choice, watch(scene, choice), bounds);
  }
}
