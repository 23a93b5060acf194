#include "io/scene_reader.hpp"

namespace grandamp {

void read_structure(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("structure"), "structure");
  if (!table.exists()) return;
  Structure structure;
  for (const std::string_view key : {"mass", "stiffness"})
    if (!table.has(key))
      table.missing(key, "needed by a structure", key == "mass" ? "a mass in kg, above 0" : "N/m, at least 0");
  structure.mass = table.number("mass", positive).value_or(0.0);
  structure.stiffness = table.number("stiffness", not_negative).value_or(0.0);
  structure.damping = table.number("damping", not_negative).value_or(0.0);
  structure.direction = table.direction("direction").value_or(structure.direction);
  structure.displacement = table.number("displacement").value_or(0.0);
  structure.velocity = table.number("velocity").value_or(0.0);
  table.finish();
  scene.structure = structure;
}

} // namespace grandamp
