#include "io/scene_keys.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace grandamp {

namespace {

using Names = std::span<const std::string_view>;

constexpr std::array<std::string_view, 12> root{"title",      "seed",    "gravity", "enclosure",
                                                "granules",   "packing", "contact", "structure",
                                                "excitation", "time",    "verlet",  "output"};
constexpr std::array<std::string_view, 5> enclosure{"shape", "size", "diameter", "height", "axis"};
constexpr std::array<std::string_view, 13> granules{"name",       "count", "total_mass", "radius", "density",
                                                    "mass",       "young", "poisson",    "speed",  "positions",
                                                    "velocities", "spins", "file"};
constexpr std::array<std::string_view, 1> packing{"kind"};
constexpr std::array<std::string_view, 7> contact{"damping", "friction", "tension", "rotation",
                                                  "granule", "wall",     "pair"};
constexpr std::array<std::string_view, 8> contact_granule{
    "stiffness",      "reference_radius", "restitution",          "alpha",
    "normal_damping", "friction",         "tangential_stiffness", "tangential_damping"};
constexpr std::array<std::string_view, 10> contact_wall{
    "stiffness", "reference_radius",     "restitution",        "alpha", "normal_damping",
    "friction",  "tangential_stiffness", "tangential_damping", "young", "poisson"};
constexpr std::array<std::string_view, 11> contact_pair{
    "between",        "stiffness", "reference_radius",     "restitution",        "alpha",
    "normal_damping", "friction",  "tangential_stiffness", "tangential_damping", "young",
    "poisson"};
constexpr std::array<std::string_view, 8> structure{"mass",         "stiffness", "damping",  "direction",
                                                    "displacement", "velocity",  "matrices", "modes"};
constexpr std::array<std::string_view, 9> modes{"mass",  "frequency",   "stiffness",    "damping_ratio", "damping",
                                                "shape", "force_shape", "displacement", "velocity"};
constexpr std::array<std::string_view, 20> excitation{"kind",
                                                      "static_deflection",
                                                      "force",
                                                      "frequency",
                                                      "amplitude",
                                                      "acceleration",
                                                      "velocity",
                                                      "direction",
                                                      "start_frequency",
                                                      "end_frequency",
                                                      "sweep",
                                                      "sweep_duration",
                                                      "period",
                                                      "force_rms",
                                                      "band",
                                                      "seed",
                                                      "start",
                                                      "pulse_duration",
                                                      "file",
                                                      "interpolation"};
constexpr std::array<std::string_view, 7> time{"duration",     "steps_per_contact", "step",     "error",
                                               "impact_speed", "integrator",        "precision"};
constexpr std::array<std::string_view, 7> verlet{"policy",       "skin",     "cell", "safety",
                                                 "max_interval", "interval", "audit"};
constexpr std::array<std::string_view, 5> output{"history_interval", "snapshot_interval", "checkpoint_interval",
                                                 "window", "energy"};

struct Table {
  std::string_view name;
  std::string_view header;
  Names keys;
};
constexpr std::array<Table, 14> tables{{{"", "the top of the file", root},
                                        {"enclosure", "[enclosure]", enclosure},
                                        {"granules", "[[granules]]", granules},
                                        {"packing", "[packing]", packing},
                                        {"contact", "[contact]", contact},
                                        {"contact.granule", "[contact.granule]", contact_granule},
                                        {"contact.wall", "[contact.wall]", contact_wall},
                                        {"contact.pair", "[[contact.pair]]", contact_pair},
                                        {"structure", "[structure]", structure},
                                        {"structure.modes", "[[structure.modes]]", modes},
                                        {"excitation", "[excitation]", excitation},
                                        {"time", "[time]", time},
                                        {"verlet", "[verlet]", verlet},
                                        {"output", "[output]", output}}};

bool is_index(std::string_view part) {
  return !part.empty() && std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

} // namespace

Names keys_of_table(std::string_view table) {
  for (const Table& known : tables)
    if (known.name == table) return known.keys;
  return {};
}

std::string other_tables_with(std::string_view key, std::string_view table) {
  std::string found;
  for (const Table& known : tables) {
    if (known.name == table || std::find(known.keys.begin(), known.keys.end(), key) == known.keys.end()) continue;
    if (!found.empty()) found += " or ";
    found += known.header;
  }
  return found;
}

std::string table_of_path(std::string_view path) {
  std::string table;
  while (!path.empty()) {
    const std::size_t dot = path.find('.');
    const std::string_view part = path.substr(0, dot);
    if (!is_index(part)) {
      if (!table.empty()) table += '.';
      table += part;
    }
    path.remove_prefix(dot == std::string_view::npos ? path.size() : dot + 1);
  }
  return table;
}

} // namespace grandamp
