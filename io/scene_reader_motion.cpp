#include "io/scene_reader.hpp"

namespace grandamp {

namespace {

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

void read_harmonic(TableReader& root, TableReader& table, Scene& scene) {
  for (const std::string_view key : {"amplitude", "velocity", "direction"})
    table.idle(key, "the kind is \"harmonic\"", "static_deflection or force, frequency");
  if (!table.has("frequency")) table.missing("frequency", "of the force", "Hz, above 0");
  scene.excitation.frequency = table.number("frequency", positive).value_or(0.0);
  if (!root.has("structure")) {
    table.wrong("kind", "a force needs a [structure] to act on", "a [structure]; or kind = \"prescribed\"");
    for (const std::string_view key : {"static_deflection", "force"})
      table.idle(key, "there is no [structure]", "a [structure]");
    return;
  }
  const std::string_view key = table.one_of({"static_deflection", "force"});
  if (key.empty()) table.missing("force", "how strong it is", "static_deflection in m, or force in N");
  if (key == "force") scene.excitation.force = table.number(key);
  if (key == "static_deflection") {
    scene.excitation.static_deflection = table.number(key);
    if (scene.structure && scene.structure->stiffness == 0.0 && scene.excitation.static_deflection)
      table.wrong(key, "gives no force, since the structure has no stiffness", "force, in N");
  }
}

void read_prescribed(TableReader& root, TableReader& table, Scene& scene) {
  for (const std::string_view key : {"static_deflection", "force"})
    table.idle(key, "the kind is \"prescribed\"", "amplitude and frequency, or velocity");
  root.idle("structure", "a prescribed motion is the enclosure's own", "no [structure]; or kind = \"harmonic\"");
  Excitation& excitation = scene.excitation;
  excitation.direction = table.direction("direction").value_or(excitation.direction);
  const std::string_view key = table.one_of({"amplitude", "velocity"});
  if (key.empty()) table.missing("amplitude", "how the enclosure moves", "amplitude and frequency, or velocity");
  if (key == "velocity") {
    excitation.velocity = table.number("velocity");
    table.idle("frequency", "the velocity is constant", "amplitude and frequency, or velocity");
    return;
  }
  excitation.amplitude = table.number("amplitude").value_or(0.0);
  if (!table.has("frequency") && !key.empty()) table.missing("frequency", "of the motion", "Hz, above 0");
  excitation.frequency = table.number("frequency", positive).value_or(0.0);
}

void read_excitation(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("excitation"), "excitation");
  if (!table.exists()) return;
  if (!table.has("kind")) table.missing("kind", "what excites", "\"harmonic\", \"prescribed\"");
  const auto kind = table.choice<ExcitationKind>(
      "kind", {{"harmonic", ExcitationKind::harmonic}, {"prescribed", ExcitationKind::prescribed}},
      {"base", "chirp", "random", "impulse", "table"});
  if (!kind) {
    // What the other keys mean depends on it.
    for (const std::string_view key : {"static_deflection", "force", "frequency", "amplitude", "velocity", "direction"})
      table.pass(key);
    table.finish();
    return;
  }
  scene.excitation.kind = *kind;
  if (*kind == ExcitationKind::harmonic) read_harmonic(root, table, scene);
  if (*kind == ExcitationKind::prescribed) read_prescribed(root, table, scene);
  table.finish();
}

} // namespace

void read_motion(TableReader& root, Scene& scene) {
  read_structure(root, scene);
  read_excitation(root, scene);
}

} // namespace grandamp
