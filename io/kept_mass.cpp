#include "io/kept_mass.hpp"

#include "io/run.hpp"
#include "io/scene_toml.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

using std::numbers::pi;

double volume(double radius) {
  return 4.0 / 3.0 * pi * radius * radius * radius;
}

double positive_number(const VaryValue& value, const std::string& key) {
  if (!value.number || !(*value.number > 0.0))
    throw UsageError(fmt::format("--keep total_mass: {} = {}: not above 0, and no mass can be kept with it; allowed: "
                                 "numbers above 0",
                                 key, value.text));
  return *value.number;
}

std::string set(const std::string& key, double value) {
  return fmt::format("{}={}", key, value_text(key, value));
}

} // namespace

KeptMass::KeptMass(const SceneDocument& document, const std::vector<std::string>& keys) {
  const toml::table tree = parse_toml(document.text);
  const toml::array* tables = tree["granules"].as_array();
  for (std::size_t i = 0; i < document.scene.populations.size(); ++i) {
    const Population& population = document.scene.populations[i];
    Kept kept;
    kept.population = i;
    kept.prefix = fmt::format("granules.{}.", i);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const int index = static_cast<int>(k);
      if (keys[k] == kept.prefix + "count") kept.count = index;
      if (keys[k] == kept.prefix + "radius") kept.radius_key = index;
      if (keys[k] == kept.prefix + "density") kept.density_key = index;
      if (keys[k] == kept.prefix + "mass") kept.mass = index;
      if (keys[k] == kept.prefix + "total_mass")
        throw UsageError(fmt::format("--keep total_mass: {} is varied itself", keys[k]));
    }
    if (kept.count < 0 && kept.radius_key < 0 && kept.density_key < 0 && kept.mass < 0) continue;
    if (population.placed)
      throw UsageError(
          fmt::format("--keep total_mass: the granules of [[granules]] {} are given one by one; allowed: a "
                      "population by count or total_mass",
                      i));
    if (population.count == 0)
      throw UsageError(
          fmt::format("--keep total_mass: [[granules]] {} has no granules, so there is no mass to keep", i));
    if (kept.count >= 0 && kept.radius_key >= 0 && (kept.density_key >= 0 || kept.mass >= 0))
      throw UsageError(
          fmt::format("--keep total_mass: count, radius and {} of [[granules]] {} are all varied: nothing is "
                      "left that could follow; allowed: two of them",
                      kept.mass >= 0 ? "mass" : "density", i));
    const toml::table* table = tables != nullptr ? (*tables)[i].as_table() : nullptr;
    const auto asked = table != nullptr ? as_double(table->get("total_mass")) : std::nullopt;
    kept.total = asked ? *asked : static_cast<double>(population.count) * population.mass;
    kept.radius = population.radius;
    const auto density = table != nullptr ? as_double(table->get("density")) : std::nullopt;
    kept.by_mass = !density;
    kept.density = density ? *density : population.mass / volume(population.radius);
    kept_.push_back(kept);
  }
  if (kept_.empty())
    throw UsageError("--keep total_mass: nothing that is varied changes the granules' mass; allowed with it: count, "
                     "radius, density or mass of [[granules]], as granules.0.radius");
}

std::vector<std::string> KeptMass::following(const Kept& kept, const std::vector<VaryValue>& values) {
  const auto given = [&](int key, const char* name) {
    return positive_number(values[static_cast<std::size_t>(key)], kept.prefix + name);
  };
  const double density = kept.density_key >= 0 ? given(kept.density_key, "density") : kept.density;
  const bool by_mass = kept.mass >= 0 || (kept.by_mass && kept.density_key < 0);
  const auto share = [&](double count, double radius) { // what one granule has, so that all have the total
    const double mass = kept.total / count;
    return by_mass ? set(kept.prefix + "mass", mass) : set(kept.prefix + "density", mass / volume(radius));
  };
  if (kept.count >= 0) {
    const double count = given(kept.count, "count");
    if (kept.radius_key >= 0) return {share(count, given(kept.radius_key, "radius"))};
    if (kept.mass >= 0)
      throw UsageError("--keep total_mass: count and mass are both varied, and their product is the total mass; "
                       "allowed: one of them, or count and radius");
    const double radius = std::cbrt(kept.total / (count * density * 4.0 / 3.0 * pi));
    std::vector<std::string> both{set(kept.prefix + "radius", radius)};
    if (by_mass) both.push_back(share(count, radius));
    return both;
  }
  const double radius = kept.radius_key >= 0 ? given(kept.radius_key, "radius") : kept.radius;
  const double mass = kept.mass >= 0 ? given(kept.mass, "mass") : density * volume(radius);
  const double count = std::round(kept.total / mass);
  if (!(count >= 1.0 && count <= static_cast<double>(most_granules)))
    throw UsageError(
        fmt::format("--keep total_mass: {} kg are {:.3g} granules of {:.3g} kg; allowed: granules of which the "
                    "total mass has from 1 to {}",
                    kept.total, kept.total / mass, mass, most_granules));
  return {set(kept.prefix + "count", count), share(count, radius)};
}

std::vector<std::string> KeptMass::overrides(const std::vector<VaryValue>& values) const {
  std::vector<std::string> all;
  for (const Kept& kept : kept_)
    for (std::string& one : following(kept, values)) all.push_back(std::move(one));
  return all;
}

} // namespace grandamp
