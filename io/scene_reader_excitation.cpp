#include "io/scene_keys.hpp"
#include "io/scene_reader.hpp"
#include "io/table_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grandamp {

namespace {

/// A narrower band is a sine; and so many sines make it up that their frequencies must be told apart.
constexpr double least_relative_band = 1.0e-6;

/// Everything but `kind` that the kind has no use for.
void refuse_others(TableReader& table, std::string_view kind, std::initializer_list<std::string_view> own,
                   const std::string& allowed) {
  for (const std::string_view key : keys_of_table("excitation"))
    if (key != "kind" && std::find(own.begin(), own.end(), key) == own.end())
      table.idle(key, fmt::format("the kind is \"{}\"", kind), allowed);
}

/// Whether there is a structure for a force to act on; without one `forces` do not apply.
bool has_structure(TableReader& root, TableReader& table, std::initializer_list<std::string_view> forces) {
  if (root.has("structure")) return true;
  table.wrong("kind", "a force needs a [structure] to act on", "a [structure]; or kind = \"prescribed\"");
  for (const std::string_view key : forces) table.idle(key, "there is no [structure]", "a [structure]");
  return false;
}

/// static_deflection or force.
void read_strength(TableReader& root, TableReader& table, Scene& scene) {
  if (!has_structure(root, table, {"static_deflection", "force"})) return;
  const std::string_view key = table.one_of({"static_deflection", "force"});
  if (key.empty()) table.missing("force", "how strong it is", "static_deflection in m, or force in N");
  if (key == "force") scene.excitation.force = table.number(key);
  if (key == "static_deflection") {
    scene.excitation.static_deflection = table.number(key);
    if (scene.structure && scene.structure->modes.size > 0)
      table.wrong(key, "a structure of several modes has no one stiffness", "force, in N");
    else if (scene.structure && scene.structure->stiffness == 0.0 && scene.excitation.static_deflection)
      table.wrong(key, "gives no force, since the structure has no stiffness", "force, in N");
  }
}

double needed(TableReader& table, std::string_view key, const std::string& why, const std::string& allowed,
              const Range& range) {
  if (!table.has(key)) table.missing(key, why, allowed);
  return table.number(key, range).value_or(0.0);
}

void read_harmonic(TableReader& root, TableReader& table, Scene& scene) {
  refuse_others(table, "harmonic", {"static_deflection", "force", "frequency"},
                "static_deflection or force, frequency");
  scene.excitation.frequency = needed(table, "frequency", "of the force", "Hz, above 0", positive);
  read_strength(root, table, scene);
}

void read_prescribed(TableReader& root, TableReader& table, Scene& scene) {
  refuse_others(table, "prescribed", {"amplitude", "frequency", "velocity", "direction"},
                "amplitude and frequency, or velocity");
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

void read_base(TableReader& root, TableReader& table, Scene& scene) {
  refuse_others(table, "base", {"amplitude", "acceleration", "frequency"}, "amplitude or acceleration, frequency");
  Excitation& excitation = scene.excitation;
  if (!root.has("structure"))
    table.wrong("kind", "a foundation needs a [structure] to stand on it",
                "a [structure]; or kind = \"prescribed\", the enclosure's own motion");
  if (scene.structure && scene.structure->modes.size > 0)
    table.wrong("kind", "a foundation in motion is for a structure of one degree of freedom",
                "a force; or a [structure] of mass, stiffness and damping");
  excitation.frequency = needed(table, "frequency", "of the foundation's motion", "Hz, above 0", positive);
  const std::string_view key = table.one_of({"amplitude", "acceleration"});
  if (key.empty())
    table.missing("amplitude", "how far the foundation moves",
                  "amplitude in m, or acceleration (its amplitude) in m/s^2");
  if (key == "amplitude") excitation.amplitude = table.number(key).value_or(0.0);
  if (key == "acceleration") excitation.acceleration = table.number(key);
}

void read_chirp(TableReader& root, TableReader& table, Scene& scene) {
  refuse_others(table, "chirp",
                {"static_deflection", "force", "start_frequency", "end_frequency", "sweep", "sweep_duration", "period"},
                "static_deflection or force, start_frequency, end_frequency, sweep, sweep_duration, period");
  Excitation& excitation = scene.excitation;
  excitation.start_frequency = needed(table, "start_frequency", "where the sweep begins", "Hz, above 0", positive);
  excitation.end_frequency = needed(table, "end_frequency", "where the sweep ends", "Hz, above 0", positive);
  excitation.sweep = table.choice<Sweep>("sweep", {{"linear", Sweep::linear}, {"logarithmic", Sweep::logarithmic}})
                         .value_or(Sweep::linear);
  excitation.sweep_duration = table.number("sweep_duration", positive);
  excitation.period = table.number("period", positive);
  read_strength(root, table, scene);
}

void read_random(TableReader& root, TableReader& table, Scene& scene) {
  refuse_others(table, "random", {"force_rms", "band", "seed", "period"}, "force_rms, band, seed, period");
  Excitation& excitation = scene.excitation;
  excitation.seed =
      static_cast<std::uint64_t>(table.integer("seed", 0, std::numeric_limits<std::int64_t>::max()).value_or(0));
  if (!table.has("band")) table.missing("band", "which frequencies it has", "[from, to] in Hz");
  if (const std::optional<std::array<double, 2>> band = table.pair("band")) {
    excitation.band = *band;
    if (!((*band)[0] >= 0.0 && (*band)[1] > 0.0 && (*band)[1] - (*band)[0] >= least_relative_band * (*band)[1]))
      table.wrong(
          "band", "out of range",
          fmt::format("[from, to] in Hz, 0 <= from < to, and to - from at least {} of to", least_relative_band));
  }
  excitation.period = table.number("period", positive);
  if (!has_structure(root, table, {"force_rms"})) return;
  excitation.force_rms = needed(table, "force_rms", "how strong it is", "N, at least 0", not_negative);
}

void read_impulse(TableReader& root, TableReader& table, Scene& scene) {
  refuse_others(table, "impulse", {"force", "start", "pulse_duration"}, "force, start, pulse_duration");
  Excitation& excitation = scene.excitation;
  excitation.start = table.number("start", not_negative).value_or(0.0);
  excitation.pulse_duration = needed(table, "pulse_duration", "of the half sine", "s, above 0", positive);
  if (!has_structure(root, table, {"force"})) return;
  if (!table.has("force")) table.missing("force", "how strong it is", "N, the peak of the half sine");
  excitation.force = table.number("force");
}

/// The file, or null: none, or a faulty one.
std::shared_ptr<const TableFile> table_file(TableReader& table) {
  if (!table.has("file")) table.missing("file", "the table", "a CSV file, relative to the scene file");
  const std::optional<std::string> name = table.text("file");
  if (!name) return nullptr;
  if (name->empty() || name->find('\0') != std::string::npos) {
    table.wrong("file", "not a file name", "a CSV file, relative to the scene file");
    return nullptr;
  }
  SceneReading& reading = table.reading();
  const std::filesystem::path path = reading.folder / *name;
  auto& known = reading.table_files[path.string()];
  if (!known) known = std::make_shared<const TableFile>(read_table_file(path));
  for (const std::string& fault : known->faults) {
    Finding finding{Problem{table.key_path("file"), shown(toml::value<std::string>(*name)),
                            known->unreadable ? fmt::format("{} {}", path.string(), fault)
                                              : fmt::format("{}, {}", path.string(), fault),
                            "a CSV file with a header row: time,force or time,displacement or time,acceleration"}};
    finding.unreadable = known->unreadable;
    reading.add(std::move(finding));
  }
  return known->faults.empty() ? known : nullptr;
}

void read_table(TableReader& root, TableReader& table, Scene& scene) {
  refuse_others(table, "table", {"file", "interpolation", "direction"}, "file, interpolation, direction");
  Excitation& excitation = scene.excitation;
  excitation.interpolation =
      table.choice<Interpolation>("interpolation", {{"cubic", Interpolation::cubic}, {"linear", Interpolation::linear}})
          .value_or(Interpolation::cubic);
  const std::shared_ptr<const TableFile> file = table_file(table);
  if (!file) return table.pass("direction");
  excitation.quantity = file->quantity;
  excitation.times = file->times;
  excitation.values = file->values;
  const bool force = file->quantity == TableQuantity::force;
  if (root.has("structure")) {
    table.idle("direction", "the structure has one", "no direction, or no [structure]");
    if (!force && scene.structure && scene.structure->modes.size > 0)
      table.wrong("file", "a foundation in motion is for a structure of one degree of freedom",
                  "a table of forces; or a [structure] of mass, stiffness and damping");
  } else if (force) {
    table.pass("direction");
    table.wrong("file", "a force needs a [structure] to act on",
                "a [structure]; or a file of time,displacement or time,acceleration, the enclosure's own motion");
  } else {
    excitation.direction = table.direction("direction").value_or(excitation.direction);
  }
  if (file->quantity == TableQuantity::displacement && excitation.interpolation == Interpolation::linear)
    table.wrong("interpolation", "a displacement with kinks has velocities that jump", "\"cubic\"");
}

} // namespace

void read_excitation(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("excitation"), "excitation");
  if (!table.exists()) return;
  if (!table.has("kind"))
    table.missing("kind", "what excites", R"("harmonic", "prescribed", "base", "chirp", "random", "impulse", "table")");
  const auto kind = table.choice<ExcitationKind>("kind", {{"harmonic", ExcitationKind::harmonic},
                                                          {"prescribed", ExcitationKind::prescribed},
                                                          {"base", ExcitationKind::base},
                                                          {"chirp", ExcitationKind::chirp},
                                                          {"random", ExcitationKind::random},
                                                          {"impulse", ExcitationKind::impulse},
                                                          {"table", ExcitationKind::table}});
  if (!kind) {
    // What the other keys mean depends on it.
    for (const std::string_view key : keys_of_table("excitation")) table.pass(key);
    table.finish();
    return;
  }
  scene.excitation.kind = *kind;
  switch (*kind) {
  case ExcitationKind::harmonic:
    read_harmonic(root, table, scene);
    break;
  case ExcitationKind::prescribed:
    read_prescribed(root, table, scene);
    break;
  case ExcitationKind::base:
    read_base(root, table, scene);
    break;
  case ExcitationKind::chirp:
    read_chirp(root, table, scene);
    break;
  case ExcitationKind::random:
    read_random(root, table, scene);
    break;
  case ExcitationKind::impulse:
    read_impulse(root, table, scene);
    break;
  case ExcitationKind::table:
    read_table(root, table, scene);
    break;
  case ExcitationKind::none:
    break;
  }
  table.finish();
}

void check_table_reach(TableReader& root, const Scene& scene) {
  const Excitation& e = scene.excitation;
  if (e.kind != ExcitationKind::table || e.quantity == TableQuantity::force || e.times.empty()) return;
  if (e.times.front() <= 0.0 && e.times.back() >= scene.time.duration * (1.0 - 1.0e-9)) return;
  TableReader(root.reading(), root.table("excitation"), "excitation")
      .wrong("file",
             fmt::format("the motion is known from {:g} to {:g} s, not for the whole run", e.times.front(),
                         e.times.back()),
             fmt::format("rows from 0 (or before) to the duration, {:g} s (or beyond)", scene.time.duration));
}

} // namespace grandamp
