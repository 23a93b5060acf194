#include "io/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace grandamp {

namespace {

double sphere_volume(double radius) {
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

bool all_equal(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [&](double value) { return value == values.front(); });
}

/// One population. Everything but `count` and the explicit lists is needed even where there are no granules: a
/// population is whole or it is a mistake.
class PopulationReader {
public:
  PopulationReader(TableReader& table, Scene& scene) : table_(table), scene_(scene) {}

  void read(GranulesRead& granules) {
    read_name();
    const std::string_view source = table_.one_of({"count", "total_mass", "positions", "file"});
    if (source.empty()) table_.missing("count", "how many granules", "one of count, total_mass, positions, file");
    if (source == "positions") read_positions();
    if (source == "file") read_file();
    if (source != "positions")
      for (const std::string_view key : {"velocities", "spins"})
        table_.idle(key, "it goes with positions", "positions, velocities, spins; or file");
    read_radius();
    read_mass();
    if (source == "count") read_count();
    if (source == "total_mass") read_total_mass();
    read_speed();
    population_.young = table_.number("young", positive);
    population_.poisson = table_.number("poisson", {-1.0, 0.5, false, true});
    const bool unknown = !counted_ && !source.empty();
    granules.any = granules.any || unknown || population_.count > 0;
    granules.by_count = granules.by_count || (!population_.placed && population_.count > 0);
    scene_.populations.push_back(std::move(population_));
  }

private:
  void read_name() {
    population_.name = table_.text("name").value_or("");
    if (population_.name == "wall")
      table_.wrong("name", "\"wall\" is what contacts call the enclosure", "any other name");
    for (const Population& other : scene_.populations)
      if (!population_.name.empty() && other.name == population_.name)
        table_.wrong("name", "another population has this name", "names that differ, or none");
  }

  void read_positions() {
    population_.placed = true;
    std::optional<std::vector<Vector3>> positions = table_.vectors("positions");
    std::optional<std::vector<Vector3>> velocities = table_.vectors("velocities");
    std::optional<std::vector<Vector3>> spins = table_.vectors("spins");
    if (!positions) return;
    population_.positions = std::move(*positions);
    population_.count = population_.positions.size();
    counted_ = population_.count > 0;
    if (!counted_) table_.wrong("positions", "no positions", "at least one; or count = 0 for no granules");
    population_.velocities = matching(std::move(velocities), "velocities");
    population_.spins = matching(std::move(spins), "spins");
  }

  std::vector<Vector3> matching(std::optional<std::vector<Vector3>> list, std::string_view key) {
    if (!list) return {};
    if (list->size() != population_.count)
      table_.wrong(key, fmt::format("{} items for {} positions", list->size(), population_.count),
                   "as many items as positions");
    return std::move(*list);
  }

  void read_file() {
    population_.placed = true;
    const std::optional<std::string> name = table_.text("file");
    if (!name) return;
    if (name->empty() || name->find('\0') != std::string::npos)
      return table_.wrong("file", "not a file name", "a CSV file, relative to the scene file");
    SceneReading& reading = table_.reading();
    const std::filesystem::path path = reading.folder / *name;
    auto& known = reading.granule_files[path.string()];
    if (!known) known = std::make_shared<const GranuleFile>(read_granule_file(path));
    file_ = known.get();
    for (const std::string& fault : file_->faults) {
      Finding finding{Problem{table_.key_path("file"), shown(toml::value<std::string>(*name)),
                              file_->unreadable ? fmt::format("{} {}", path.string(), fault)
                                                : fmt::format("{}, {}", path.string(), fault),
                              "a CSV file with a header row: x,y,z and any of radius,density,vx,vy,vz,wx,wy,wz,id"}};
      finding.unreadable = file_->unreadable;
      reading.add(std::move(finding));
    }
    if (!file_->faults.empty()) return;
    population_.positions = file_->positions;
    population_.velocities = file_->velocities;
    population_.spins = file_->spins;
    population_.radii = file_->radii;
    population_.count = population_.positions.size();
    counted_ = true;
  }

  bool file_has(const std::vector<double> GranuleFile::*column) const {
    return file_ != nullptr && file_->faults.empty() && !(file_->*column).empty();
  }

  void read_radius() {
    if (file_has(&GranuleFile::radii)) {
      table_.idle("radius", "the file has a column radius", "the file's own, or a file without that column");
      population_.radius = *std::max_element(population_.radii.begin(), population_.radii.end());
      return;
    }
    const bool faulty_file = file_ != nullptr && !file_->faults.empty();
    if (!table_.has("radius") && !faulty_file)
      table_.missing("radius", "the size of the granules", "a radius in m, above 0");
    population_.radius = table_.number("radius", positive).value_or(0.0);
  }

  void read_mass() {
    if (file_has(&GranuleFile::densities)) {
      for (const std::string_view key : {"density", "mass"})
        table_.idle(key, "the file has a column density", "the file's own, or a file without that column");
      set_masses([this](std::size_t i, double radius) { return file_->densities[i] * sphere_volume(radius); });
      return;
    }
    const std::string_view key = table_.one_of({"density", "mass"});
    const bool faulty_file = file_ != nullptr && !file_->faults.empty();
    if (key.empty()) {
      if (!faulty_file) table_.missing("density", "how heavy the granules are", "density in kg/m^3, or mass in kg");
      return;
    }
    const std::optional<double> value = table_.number(key, positive);
    if (!value) return;
    if (key == "mass") {
      population_.mass = *value;
      return;
    }
    set_masses([&value](std::size_t, double radius) { return *value * sphere_volume(radius); });
    if (population_.radius > 0.0 && !(population_.mass > 0.0 && std::isfinite(population_.mass)))
      table_.wrong(key, fmt::format("gives a granule of {} kg", population_.mass), "a mass that a number can hold");
  }

  /// One mass for all where they are equal: a population of one size is then seen as such.
  template <class Law> void set_masses(const Law& mass_of) {
    const bool listed = !population_.radii.empty() || file_has(&GranuleFile::densities);
    if (!listed) {
      population_.mass = mass_of(0, population_.radius);
      return;
    }
    population_.masses.resize(population_.count);
    for (std::size_t i = 0; i < population_.count; ++i)
      population_.masses[i] = mass_of(i, population_.radii.empty() ? population_.radius : population_.radii[i]);
    for (const double mass : population_.masses)
      if (population_.radius > 0.0 && !(mass > 0.0 && std::isfinite(mass))) {
        table_.wrong("file", fmt::format("a granule of {} kg", mass), "masses that a number can hold");
        break;
      }
    population_.mass = *std::max_element(population_.masses.begin(), population_.masses.end());
    if (all_equal(population_.masses)) population_.masses.clear();
    if (!population_.radii.empty() && all_equal(population_.radii)) population_.radii.clear();
  }

  void read_count() {
    const std::optional<std::int64_t> count = table_.integer("count", 0, static_cast<std::int64_t>(most_granules));
    counted_ = count.has_value();
    population_.count = static_cast<std::size_t>(count.value_or(0));
  }

  void read_total_mass() {
    const std::optional<double> total = table_.number("total_mass", positive);
    if (!total || !(population_.mass > 0.0)) return;
    const double count = std::round(*total / population_.mass);
    if (!(count >= 1.0 && count <= static_cast<double>(most_granules)))
      return table_.wrong("total_mass",
                          fmt::format("that is {} granules of {} kg", *total / population_.mass, population_.mass),
                          fmt::format("from one granule to {}", most_granules));
    counted_ = true;
    population_.count = static_cast<std::size_t>(count);
  }

  void read_speed() {
    if (!population_.velocities.empty() || table_.has("velocities")) {
      table_.idle("speed", "the granules' velocities are given one by one", "one of speed and velocities");
      return;
    }
    population_.speed = table_.number("speed", not_negative).value_or(0.0);
  }

  TableReader& table_;
  Scene& scene_;
  Population population_;
  const GranuleFile* file_ = nullptr;
  bool counted_ = false;
};

} // namespace

GranulesRead read_granules(TableReader& root, Scene& scene) {
  GranulesRead granules;
  for (const toml::table* table : root.tables("granules"))
    granules.tables.emplace_back(root.reading(), table, fmt::format("granules.{}", granules.tables.size()));
  for (TableReader& table : granules.tables) PopulationReader(table, scene).read(granules);
  return granules;
}

void read_packing(TableReader& root, Scene& scene, GranulesRead& granules) {
  TableReader table(root.reading(), root.table("packing"), "packing");
  scene.packing =
      table.choice<PackingKind>("kind", {{"settled", PackingKind::settled}, {"random", PackingKind::random}})
          .value_or(PackingKind::settled);
  table.finish();
  if (scene.packing != PackingKind::settled || !granules.by_count) return;
  const bool weightless = scene.gravity == Vector3{} && (!root.has("gravity") || root.vector("gravity"));
  if (weightless)
    table.wrong("kind", "\"settled\" (which is the default) needs gravity to settle under",
                "gravity other than [0, 0, 0], or kind = \"random\"");
  for (std::size_t i = 0; i < scene.populations.size(); ++i)
    if (!scene.populations[i].placed)
      granules.tables[i].idle("speed", "packing \"settled\" leaves the granules at rest",
                              "packing.kind = \"random\", or no speed");
}

} // namespace grandamp
