// One granule in the grip of many heavy ones.
#pragma once

#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace grandamp::test {

/// Unit vectors to the holders: on a ring about z (the worst case for a spin about z), or all around.
inline std::vector<Vector3> ring(int count) {
  std::vector<Vector3> directions;
  for (int n = 0; n < count; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / count;
    directions.push_back({std::cos(angle), std::sin(angle), 0.0});
  }
  return directions;
}

inline std::vector<Vector3> all_around(int count) {
  std::vector<Vector3> directions;
  const auto add = [&](double x, double y, double z) {
    const double size = std::hypot(x, y, z);
    directions.push_back({x / size, y / size, z / size});
  };
  if (count == 4) {
    for (const double s : {-1.0, 1.0}) {
      add(1.0, s, s);
      add(-1.0, s, -s);
    }
  } else if (count == 6) {
    for (const double s : {-1.0, 1.0}) {
      add(s, 0.0, 0.0);
      add(0.0, s, 0.0);
      add(0.0, 0.0, s);
    }
  } else {
    for (const double s : {-1.0, 1.0})
      for (const double t : {-std::numbers::phi, std::numbers::phi}) {
        add(0.0, s, t);
        add(s, t, 0.0);
        add(t, 0.0, s);
      }
  }
  return directions;
}

/// The held granule is the first; the holders are a million times heavier and pressed 0.1 % of a radius into it.
inline Scene held(const std::vector<Vector3>& directions, const Vector3& spin, double friction, double steps = 8.0) {
  const double radius = 1.5e-3, holder = 0.3 * radius, side = 20.0 * radius;
  Scene scene = box_scene(side, radius);
  scene.contact.granule.friction = friction;
  Population& population = scene.populations[0];
  const double middle = 0.5 * side;
  add_granule(scene, {middle, middle, middle}, {}, spin);
  population.radii = {radius};
  population.masses = {population.mass};
  for (const Vector3& direction : directions) {
    const double reach = 1.2997 * radius;
    add_granule(scene, {middle + reach * direction[0], middle + reach * direction[1], middle + reach * direction[2]});
    population.radii.push_back(holder);
    population.masses.push_back(1.0e6 * population.mass);
  }
  scene.time.impact_speed = 1.0;
  const double stiffness = 1.0e7 * std::sqrt(2.0 * 0.3 / 1.3 * radius / 3.0e-3);
  scene.time.duration = 60.0 * contact_duration(population.mass, stiffness, 1.0) / steps;
  use_step(scene, contact_duration(population.mass, stiffness, 1.0) / steps);
  return scene;
}

} // namespace grandamp::test
