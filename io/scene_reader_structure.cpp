#include "io/matrix_file.hpp"
#include "io/scene_reader.hpp"
#include "solver/several_modes.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace grandamp {

namespace {

/// Of one of the structure's modes: m q'' + c q' + k q = force_shape F + shape . R.
struct Mode {
  double mass = 0.0, damping = 0.0, stiffness = 0.0;
  Vector3 shape{};
  double force_shape = 0.0;
  double displacement = 0.0, velocity = 0.0;
};

Mode read_mode(TableReader& table, const Vector3& direction) {
  Mode mode;
  if (!table.has("mass")) table.missing("mass", "needed by a mode", "the modal mass in kg, above 0");
  mode.mass = table.number("mass", positive).value_or(0.0);
  const std::string_view stiffness = table.one_of({"frequency", "stiffness"});
  if (stiffness.empty()) table.missing("frequency", "needed by a mode", "frequency in Hz, or stiffness in N/m");
  if (stiffness == "stiffness") mode.stiffness = table.number(stiffness, not_negative).value_or(0.0);
  if (stiffness == "frequency") {
    const double w = 2.0 * std::numbers::pi * table.number(stiffness, not_negative).value_or(0.0);
    mode.stiffness = mode.mass * w * w;
  }
  const std::string_view damping = table.one_of({"damping_ratio", "damping"});
  if (damping == "damping") mode.damping = table.number(damping, not_negative).value_or(0.0);
  if (damping == "damping_ratio")
    mode.damping = 2.0 * table.number(damping, not_negative).value_or(0.0) * std::sqrt(mode.mass * mode.stiffness);
  if (!table.has("shape")) table.missing("shape", "how the enclosure moves in it", "[x, y, z]");
  mode.shape = table.vector("shape").value_or(Vector3{});
  const double along = mode.shape[0] * direction[0] + mode.shape[1] * direction[1] + mode.shape[2] * direction[2];
  mode.force_shape = table.number("force_shape").value_or(along);
  mode.displacement = table.number("displacement").value_or(0.0);
  mode.velocity = table.number("velocity").value_or(0.0);
  table.finish();
  return mode;
}

SeveralModes in_matrices(const std::vector<Mode>& modes) {
  SeveralModes all;
  const std::size_t n = all.size = modes.size();
  for (auto* matrix : {&all.mass, &all.damping, &all.stiffness}) matrix->assign(n * n, 0.0);
  all.attachment.assign(3 * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    all.mass[i * n + i] = modes[i].mass;
    all.damping[i * n + i] = modes[i].damping;
    all.stiffness[i * n + i] = modes[i].stiffness;
    for (std::size_t k = 0; k < 3; ++k) all.attachment[k * n + i] = modes[i].shape[k];
    all.force.push_back(modes[i].force_shape);
    all.displacement.push_back(modes[i].displacement);
    all.velocity.push_back(modes[i].velocity);
  }
  return all;
}

/// A single mode whose shape is the direction, of length one, and on which the force acts as on the enclosure.
bool is_plain(const Mode& mode, const Vector3& direction) {
  return mode.shape == direction && mode.force_shape == 1.0;
}

void read_modes(TableReader& table, Structure& structure) {
  const std::vector<const toml::table*> tables = table.tables("modes");
  std::vector<Mode> modes;
  const std::size_t faults = table.reading().findings.size();
  for (const toml::table* one : tables) {
    TableReader reader(table.reading(), one, fmt::format("structure.modes.{}", modes.size()));
    modes.push_back(read_mode(reader, structure.direction));
  }
  if (modes.empty()) table.wrong("modes", "no modes", "a list of modes, one at least");
  if (table.reading().findings.size() != faults) return;
  if (modes.size() == 1 && is_plain(modes[0], structure.direction)) {
    structure.mass = modes[0].mass;
    structure.stiffness = modes[0].stiffness;
    structure.damping = modes[0].damping;
    structure.displacement = modes[0].displacement;
    structure.velocity = modes[0].velocity;
    return;
  }
  structure.modes = in_matrices(modes);
  for (const MatrixFault& fault : faults_of(structure.modes))
    table.wrong("modes", fmt::format("{}: {}", fault.key, fault.message), fault.allowed);
}

void read_matrices(TableReader& table, Structure& structure) {
  const std::optional<std::string> name = table.text("matrices");
  if (!name) return;
  if (name->empty() || name->find('\0') != std::string::npos)
    return table.wrong("matrices", "not a file name", "a CSV file, relative to the scene file");
  const std::filesystem::path path = table.reading().folder / *name;
  const MatrixFile file = read_matrix_file(path, structure.direction);
  for (const std::string& fault : file.faults) {
    Finding finding{Problem{table.key_path("matrices"), shown(toml::value<std::string>(*name)),
                            fmt::format("{}{} {}", path.string(), file.unreadable ? "" : ",", fault),
                            "a CSV file of rows mass, damping, stiffness, x, y, z, force, each with n numbers"}};
    finding.unreadable = file.unreadable;
    table.reading().add(std::move(finding));
  }
  if (file.faults.empty()) structure.modes = file.modes;
}

void read_one_degree_of_freedom(TableReader& table, Structure& structure) {
  for (const std::string_view key : {"mass", "stiffness"})
    if (!table.has(key))
      table.missing(key, "needed by a structure", key == "mass" ? "a mass in kg, above 0" : "N/m, at least 0");
  structure.mass = table.number("mass", positive).value_or(0.0);
  structure.stiffness = table.number("stiffness", not_negative).value_or(0.0);
  structure.damping = table.number("damping", not_negative).value_or(0.0);
  structure.displacement = table.number("displacement").value_or(0.0);
  structure.velocity = table.number("velocity").value_or(0.0);
}

} // namespace

void read_structure(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("structure"), "structure");
  if (!table.exists()) return;
  Structure structure;
  structure.direction = table.direction("direction").value_or(structure.direction);
  const std::string_view several = table.one_of({"modes", "matrices"});
  if (several.empty()) {
    read_one_degree_of_freedom(table, structure);
  } else {
    for (const std::string_view key : {"mass", "stiffness", "damping", "displacement", "velocity"})
      table.idle(key, fmt::format("{} are given", several),
                 fmt::format("{}, direction; or mass, stiffness, damping, direction, displacement, velocity", several));
    if (several == "modes")
      read_modes(table, structure);
    else
      read_matrices(table, structure);
  }
  table.finish();
  scene.structure = structure;
}

} // namespace grandamp
