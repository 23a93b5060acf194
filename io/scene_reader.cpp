#include "io/scene_reader.hpp"

#include "solver/measures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace grandamp {

namespace {

void read_enclosure(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("enclosure"), "enclosure");
  if (!root.has("enclosure")) return root.missing("enclosure", "what holds the granules", "a table [enclosure]");
  if (!table.exists()) return;
  if (!table.has("shape")) table.missing("shape", "the form of the enclosure", "\"box\", \"cylinder\"");
  const auto shape =
      table.choice<EnclosureShape>("shape", {{"box", EnclosureShape::box}, {"cylinder", EnclosureShape::cylinder}});
  if (shape == EnclosureShape::box) {
    if (!table.has("size")) table.missing("size", "the inner lengths of the box", "three lengths [x, y, z] in m");
    scene.enclosure.size = table.vector("size", positive).value_or(Vector3{});
    for (const std::string_view key : {"diameter", "height", "axis"}) table.idle(key, "a box has a size", "size");
  } else if (shape == EnclosureShape::cylinder) {
    for (const std::string_view key : {"diameter", "height"})
      if (!table.has(key)) table.missing(key, "needed by a cylinder", "a length in m");
    scene.enclosure.diameter = table.number("diameter", positive).value_or(0.0);
    scene.enclosure.height = table.number("height", positive).value_or(0.0);
    scene.enclosure.axis = table.choice<int>("axis", {{"x", 0}, {"y", 1}, {"z", 2}}).value_or(2);
    table.idle("size", "a cylinder has a diameter and a height", "diameter, height");
  } else {
    for (const std::string_view key : {"size", "diameter", "height", "axis"}) table.pass(key); // whose, nobody knows
  }
  scene.enclosure.shape = shape.value_or(EnclosureShape::box);
  table.finish();
}

double least_width(const Enclosure& enclosure) {
  if (enclosure.shape == EnclosureShape::cylinder) return std::min(enclosure.diameter, enclosure.height);
  return *std::min_element(enclosure.size.begin(), enclosure.size.end());
}

double solid_volume(const Population& population) {
  double cubes = static_cast<double>(population.count) * population.radius * population.radius * population.radius;
  if (!population.radii.empty()) {
    cubes = 0.0;
    for (const double radius : population.radii) cubes += radius * radius * radius;
  }
  return 4.0 / 3.0 * std::numbers::pi * cubes;
}

/// No arrangement of equal spheres is denser, and mixtures that are a damper's never come near.
constexpr double densest_fill = 0.7405;

void check_room(const Scene& scene, GranulesRead& granules) {
  const double width = least_width(scene.enclosure), volume = volume_of(scene.enclosure);
  double solid = 0.0, count = 0.0, largest = 0.0;
  std::size_t largest_index = 0;
  for (std::size_t i = 0; i < scene.populations.size(); ++i) {
    const Population& population = scene.populations[i];
    const double radius = population.radii.empty()
                              ? population.radius
                              : *std::max_element(population.radii.begin(), population.radii.end());
    if (population.count > 0 && width > 0.0 && 2.0 * radius > width)
      granules.tables[i].wrong(granules.tables[i].has("radius") ? "radius" : "file",
                               fmt::format("a granule {} m wide does not fit into the enclosure", 2.0 * radius),
                               fmt::format("a radius of at most {} m", width / 2.0));
    const double own = solid_volume(population);
    solid += own;
    count += static_cast<double>(population.count);
    if (own > largest) {
      largest = own;
      largest_index = i;
    }
  }
  if (granules.tables.empty() || scene.populations.empty()) return;
  TableReader& table = granules.tables[largest_index];
  std::string_view key = "count";
  for (const std::string_view one : {"file", "positions", "total_mass"})
    if (table.has(one)) key = one;
  if (volume > 0.0 && solid > densest_fill * volume)
    table.wrong(
        key,
        fmt::format("the granules' solid volume is {:.3g} times the enclosure's of {:.3g} m^3", solid / volume, volume),
        fmt::format("at most {} times: no packing is denser", densest_fill));
  if (count > static_cast<double>(most_granules))
    table.wrong(key, fmt::format("{:.0f} granules in all", count), fmt::format("at most {}", most_granules));
}

} // namespace

Scene read_tree(const toml::table& tree, SceneReading& reading) {
  Scene scene;
  TableReader root(reading, &tree, "");
  scene.title = root.text("title").value_or("");
  scene.seed =
      static_cast<std::uint64_t>(root.integer("seed", 0, std::numeric_limits<std::int64_t>::max()).value_or(1));
  scene.gravity = root.vector("gravity").value_or(Vector3{});
  read_enclosure(root, scene);
  GranulesRead granules = read_granules(root, scene);
  check_room(scene, granules);
  read_packing(root, scene, granules);
  read_contact(root, scene, granules);
  read_structure(root, scene);
  read_excitation(root, scene);
  read_time(root, scene);
  check_table_reach(root, scene);
  read_verlet(root, scene);
  read_output(root, scene);
  for (TableReader& table : granules.tables) table.finish();
  root.finish();
  return scene;
}

} // namespace grandamp
