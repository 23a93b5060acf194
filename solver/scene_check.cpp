#include "solver/scene_check.hpp"

#include "solver/excitation_signal.hpp"
#include "solver/measures.hpp"
#include "solver/periodic_random_force.hpp"
#include "solver/several_modes.hpp"

#include <fmt/format.h>
#include <limits>

namespace grandamp {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Equal spheres fill at most 0.7405 of space; random ones 0.64.
constexpr double densest_fraction = 0.7405;
constexpr double random_fraction = 0.64;

class Faults {
public:
  void add(std::string key, std::string value, std::string message, std::string allowed) {
    list_.push_back({std::move(key), std::move(value), std::move(message), std::move(allowed)});
  }

  bool finite(const std::string& key, double value) {
    return within(key, value, -infinity, infinity, "a finite number");
  }
  bool positive(const std::string& key, double value) {
    return within(key, value, std::numeric_limits<double>::min(), infinity, "above 0");
  }
  bool not_negative(const std::string& key, double value) { return within(key, value, 0.0, infinity, "at least 0"); }

  bool finite(const std::string& key, const Vector3& value) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!finite(fmt::format("{}.{}", key, k), value[k])) return false;
    return true;
  }

  void unit(const std::string& key, const Vector3& value) {
    if (finite(key, value) && std::abs(norm(value) - 1.0) > 1.0e-9)
      add(key, fmt::format("length {:.6g}", norm(value)), "not a unit vector", "a vector of length 1");
  }

  bool empty() const { return list_.empty(); }
  std::vector<Problem> take() { return std::move(list_); }

private:
  bool within(const std::string& key, double value, double least, double most, const char* allowed) {
    if (std::isfinite(value) && value >= least && value <= most) return true;
    add(key, fmt::format("{}", value), std::isfinite(value) ? "out of range" : "not finite", allowed);
    return false;
  }

  std::vector<Problem> list_;
};

void check_enclosure(Faults& faults, const Enclosure& enclosure) {
  if (enclosure.shape == EnclosureShape::box) {
    for (std::size_t k = 0; k < 3; ++k) faults.positive(fmt::format("enclosure.size.{}", k), enclosure.size[k]);
    return;
  }
  faults.positive("enclosure.diameter", enclosure.diameter);
  faults.positive("enclosure.height", enclosure.height);
  if (enclosure.axis < 0 || enclosure.axis > 2)
    faults.add("enclosure.axis", fmt::format("{}", enclosure.axis), "no such axis", "0, 1 or 2");
}

/// Explicit values of one granule each: as many as granules, all finite and, where it matters, positive.
void check_lists(Faults& faults, const Population& population, const std::string& key) {
  const auto count = [&](const char* name, std::size_t size, bool optional) {
    if (size == population.count || (optional && size == 0)) return;
    faults.add(fmt::format("{}.{}", key, name), fmt::format("{} values", size), "one for each granule is needed",
               fmt::format("{} values", population.count));
  };
  count("positions", population.positions.size(), !population.placed);
  count("velocities", population.velocities.size(), true);
  count("spins", population.spins.size(), true);
  count("radii", population.radii.size(), true);
  count("masses", population.masses.size(), true);
  const auto vectors = [&](const char* name, const std::vector<Vector3>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!faults.finite(fmt::format("{}.{}.{}", key, name, i), values[i])) return; // the first is enough
  };
  vectors("positions", population.positions);
  vectors("velocities", population.velocities);
  vectors("spins", population.spins);
  const auto numbers = [&](const char* name, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!faults.positive(fmt::format("{}.{}.{}", key, name, i), values[i])) return;
  };
  numbers("radii", population.radii);
  numbers("masses", population.masses);
}

void check_population(Faults& faults, const Scene& scene, std::size_t index) {
  const Population& population = scene.populations[index];
  const std::string key = fmt::format("granules.{}", index);
  if (population.count == 0) return;
  if (population.radii.empty()) faults.positive(key + ".radius", population.radius);
  if (population.masses.empty()) faults.positive(key + ".mass", population.mass);
  faults.not_negative(key + ".speed", population.speed);
  if (population.young) faults.positive(key + ".young", *population.young);
  if (population.poisson) faults.finite(key + ".poisson", *population.poisson);
  check_lists(faults, population, key);
  if (!population.placed && scene.packing == PackingKind::settled && population.speed > 0.0)
    faults.add(key + ".speed", fmt::format("{:g}", population.speed), "poured granules start at rest",
               "0, or packing.kind = \"random\"");
}

void check_granules(Faults& faults, const Scene& scene) {
  std::size_t placed_by_packing = 0, count = 0;
  for (std::size_t a = 0; a < scene.populations.size(); ++a) {
    const std::size_t here = scene.populations[a].count;
    if (here > most_granules || count + here > most_granules) {
      faults.add(fmt::format("granules.{}.count", a), fmt::format("{}", here), "too many granules",
                 fmt::format("at most {} in all", most_granules));
      return;
    }
    count += here;
    if (!scene.populations[a].placed) placed_by_packing += here;
    check_population(faults, scene, a);
  }
  if (placed_by_packing > 0 && scene.packing == PackingKind::settled && norm(scene.gravity) == 0.0)
    faults.add("packing.kind", "settled", "nothing settles without gravity", "\"random\", or gravity");
}

/// Whether they fit; needs a scene whose sizes are right.
void check_fit(Faults& faults, const Scene& scene) {
  const Vector3 box = bounding_box(scene.enclosure);
  const double narrowest = std::min({box[0], box[1], box[2]});
  for (std::size_t a = 0; a < scene.populations.size(); ++a) {
    const Population& population = scene.populations[a];
    if (population.count == 0) continue;
    double largest = population.radii.empty() ? population.radius : 0.0;
    for (const double radius : population.radii) largest = std::max(largest, radius);
    if (2.0 * largest > narrowest)
      faults.add(fmt::format("granules.{}.radius", a), fmt::format("{:g}", largest),
                 "a granule wider than the enclosure", fmt::format("at most {:.6g} m", 0.5 * narrowest));
  }
  const double fraction = solid_volume(scene) / volume_of(scene.enclosure);
  const bool by_count = any_by_count(scene);
  // A few granules as wide as their box are a packing of their own: 0.52 for one in a cube, and never above 0.7405.
  const double most = by_count ? random_fraction : densest_fraction;
  if (fraction > most)
    faults.add("granules", fmt::format("solid fraction {:.4g}", fraction),
               by_count ? "more granules than can be placed at random" : "more granules than the enclosure can hold",
               fmt::format("a solid fraction of at most {:g}: about {} granules", most,
                           static_cast<std::size_t>(static_cast<double>(granule_count(scene)) * most / fraction)));
}

/// A narrower band is a sine.
constexpr double least_relative_band = 1.0e-6;

void check_table(Faults& faults, const Scene& scene) {
  const Excitation& e = scene.excitation;
  if (e.times.size() < 2 || e.times.size() != e.values.size())
    return faults.add("excitation.times", fmt::format("{} times, {} values", e.times.size(), e.values.size()),
                      "not a table", "two rows at least, and a value for each time");
  for (std::size_t k = 0; k < e.times.size(); ++k) {
    if (!faults.finite(fmt::format("excitation.times.{}", k), e.times[k]) ||
        !faults.finite(fmt::format("excitation.values.{}", k), e.values[k]))
      return;
    if (k > 0 && !(e.times[k] > e.times[k - 1]))
      return faults.add(fmt::format("excitation.times.{}", k), fmt::format("{:g}", e.times[k]),
                        "not after the one before", "increasing times");
  }
  if (e.quantity == TableQuantity::force) return;
  if (e.quantity == TableQuantity::displacement && e.interpolation == Interpolation::linear)
    faults.add("excitation.interpolation", "linear", "a displacement with kinks has velocities that jump", "\"cubic\"");
  // How a foundation moves on after the last row, nobody has said.
  if (e.times.front() > 0.0 || e.times.back() < scene.time.duration * (1.0 - 1.0e-9))
    faults.add("excitation.times", fmt::format("{:g} to {:g} s", e.times.front(), e.times.back()),
               "the motion is not known for the whole run",
               fmt::format("rows from 0 (or before) to {:g} s (or beyond)", scene.time.duration));
}

void check_driving_force(Faults& faults, const Excitation& e) {
  if (e.force.has_value() == e.static_deflection.has_value())
    faults.add("excitation.force", "", e.force ? "given beside static_deflection" : "missing",
               "force or static_deflection, one of them");
  if (e.force) faults.finite("excitation.force", *e.force);
  if (e.static_deflection) faults.finite("excitation.static_deflection", *e.static_deflection);
}

const char* name(ExcitationKind kind) {
  switch (kind) {
  case ExcitationKind::harmonic:
    return "harmonic";
  case ExcitationKind::prescribed:
    return "prescribed";
  case ExcitationKind::base:
    return "base";
  case ExcitationKind::chirp:
    return "chirp";
  case ExcitationKind::random:
    return "random";
  case ExcitationKind::impulse:
    return "impulse";
  case ExcitationKind::table:
    return "table";
  case ExcitationKind::none:
    break;
  }
  return "none";
}

void check_prescribed(Faults& faults, const Scene& scene) {
  const Excitation& e = scene.excitation;
  if (scene.structure)
    faults.add("excitation.kind", "prescribed", "a prescribed motion leaves no room for a structure",
               "\"harmonic\", or no [structure]");
  faults.unit("excitation.direction", e.direction);
  if (e.velocity) {
    faults.finite("excitation.velocity", *e.velocity);
  } else {
    faults.finite("excitation.amplitude", e.amplitude);
    faults.positive("excitation.frequency", e.frequency);
  }
}

/// A force that repeats itself is made of the multiples of 1/period in its band.
void check_lines(Faults& faults, const Excitation& e) {
  if (!(e.band[1] > e.band[0])) return; // told already
  const double lines = std::floor((e.band[1] - e.band[0]) * *e.period);
  if (lines >= 3.0 && lines <= static_cast<double>(PeriodicRandomForce::most_lines)) return;
  faults.add("excitation.period", fmt::format("{:g}", *e.period),
             fmt::format("the band holds {:.6g} of its multiples of 1/period", lines),
             fmt::format("a period from {:.6g} to {:.6g} s", 4.0 / (e.band[1] - e.band[0]),
                         static_cast<double>(PeriodicRandomForce::most_lines) / (e.band[1] - e.band[0])));
}

void check_excitation(Faults& faults, const Scene& scene) {
  const Excitation& e = scene.excitation;
  const bool needs_structure = e.kind != ExcitationKind::none && e.kind != ExcitationKind::prescribed &&
                               !(e.kind == ExcitationKind::table && e.quantity != TableQuantity::force);
  if (needs_structure && !scene.structure)
    faults.add("excitation.kind", name(e.kind),
               e.kind == ExcitationKind::base ? "a foundation needs a structure to stand on it"
                                              : "a force needs a structure to act on",
               "\"prescribed\", or a [structure]");
  switch (e.kind) {
  case ExcitationKind::none:
    break;
  case ExcitationKind::harmonic:
    faults.positive("excitation.frequency", e.frequency);
    check_driving_force(faults, e);
    break;
  case ExcitationKind::prescribed:
    check_prescribed(faults, scene);
    break;
  case ExcitationKind::base:
    faults.positive("excitation.frequency", e.frequency);
    faults.finite("excitation.amplitude", e.amplitude);
    if (e.acceleration) faults.finite("excitation.acceleration", *e.acceleration);
    break;
  case ExcitationKind::chirp:
    faults.positive("excitation.start_frequency", e.start_frequency);
    faults.positive("excitation.end_frequency", e.end_frequency);
    if (e.sweep_duration) faults.positive("excitation.sweep_duration", *e.sweep_duration);
    if (e.period && faults.positive("excitation.period", *e.period) && e.sweep_duration &&
        *e.sweep_duration > *e.period)
      faults.add("excitation.period", fmt::format("{:g}", *e.period), "shorter than a sweep",
                 fmt::format("at least sweep_duration, {:g} s", *e.sweep_duration));
    check_driving_force(faults, e);
    break;
  case ExcitationKind::random:
    faults.not_negative("excitation.force_rms", e.force_rms);
    if (faults.not_negative("excitation.band.0", e.band[0]) && faults.positive("excitation.band.1", e.band[1]) &&
        !(e.band[1] - e.band[0] >= least_relative_band * e.band[1]))
      faults.add("excitation.band", fmt::format("[{:g}, {:g}]", e.band[0], e.band[1]), "not a band",
                 fmt::format("from < to, and to - from at least {:g} of to", least_relative_band));
    else if (e.period && faults.positive("excitation.period", *e.period))
      check_lines(faults, e);
    break;
  case ExcitationKind::impulse:
    if (e.force)
      faults.finite("excitation.force", *e.force);
    else
      faults.add("excitation.force", "", "missing", "N, the peak of the pulse");
    faults.not_negative("excitation.start", e.start);
    faults.positive("excitation.pulse_duration", e.pulse_duration);
    break;
  case ExcitationKind::table:
    if (!scene.structure && e.quantity != TableQuantity::force) faults.unit("excitation.direction", e.direction);
    check_table(faults, scene);
    break;
  }
}

void check_motion(Faults& faults, const Scene& scene) {
  if (scene.structure) {
    const Structure& s = *scene.structure;
    if (s.modes.size == 0) {
      faults.positive("structure.mass", s.mass);
      faults.not_negative("structure.stiffness", s.stiffness);
      faults.not_negative("structure.damping", s.damping);
    } else {
      for (const MatrixFault& fault : faults_of(s.modes))
        faults.add("structure.modes." + fault.key, "", fault.message, fault.allowed);
      const Excitation& e = scene.excitation;
      if (e.kind == ExcitationKind::base || is_motion_table(e))
        faults.add("excitation.kind", name(e.kind),
                   "a foundation in motion is for a structure of one degree of freedom",
                   "a force; or a structure of mass, stiffness and damping");
      if (e.static_deflection)
        faults.add("excitation.static_deflection", fmt::format("{:g}", *e.static_deflection),
                   "a structure of several modes has no one stiffness", "force, in N");
    }
    faults.unit("structure.direction", s.direction);
    faults.finite("structure.displacement", s.displacement);
    faults.finite("structure.velocity", s.velocity);
  }
  check_excitation(faults, scene);
}

/// Beyond, a contact means nothing.
constexpr double largest_error = 0.5;

void check_controls(Faults& faults, const Scene& scene) {
  const TimeControl& time = scene.time;
  const bool lasts = faults.positive("time.duration", time.duration);
  faults.positive("time.steps_per_contact", time.steps_per_contact);
  if (time.error && !(*time.error > 0.0 && *time.error <= largest_error))
    faults.add("time.error", fmt::format("{:g}", *time.error), "out of range",
               fmt::format("above 0 and at most {:g}", largest_error));
  if (time.error && time.step)
    faults.add("time.error", fmt::format("{:g}", *time.error), "given beside time.step", "one of them");
  if (time.step && faults.positive("time.step", *time.step) && lasts && *time.step > time.duration)
    faults.add("time.step", fmt::format("{:g}", *time.step), "longer than the duration",
               fmt::format("at most {:g} s", time.duration));
  if (time.impact_speed) faults.positive("time.impact_speed", *time.impact_speed);
  if (time.precision == Precision::mixed && scene.contact.friction == FrictionLaw::spring)
    faults.add("time.precision", "mixed", "not with contact.friction = \"spring\"",
               "\"double\"; or friction \"coulomb\" or \"none\"");
  if (time.precision == Precision::mixed && scene.contact.damping != NormalDamping::none && !scene.contact.tension)
    faults.add("time.precision", "mixed", "not with contact.tension = false", "\"double\"; or tension = true");

  const VerletControl& verlet = scene.verlet;
  const double skin = verlet.skin.value_or(0.0);
  if (faults.not_negative("verlet.skin", skin) && verlet.cell && faults.positive("verlet.cell", *verlet.cell) &&
      *verlet.cell < 1.0 + skin)
    faults.add("verlet.cell", fmt::format("{:g}", *verlet.cell), "neighbours would be two cells away",
               fmt::format("at least 1 + skin = {:g}", 1.0 + skin));
  faults.positive("verlet.safety", verlet.safety);
  if (verlet.max_interval < 1)
    faults.add("verlet.max_interval", fmt::format("{}", verlet.max_interval), "out of range", "at least 1");
  if (verlet.interval < 1)
    faults.add("verlet.interval", fmt::format("{}", verlet.interval), "out of range", "at least 1");
  if (verlet.audit < 0) faults.add("verlet.audit", fmt::format("{}", verlet.audit), "out of range", "at least 0");

  const OutputControl& output = scene.output;
  faults.positive("output.history_interval", output.history_interval);
  faults.not_negative("output.snapshot_interval", output.snapshot_interval);
  faults.not_negative("output.checkpoint_interval", output.checkpoint_interval);
  if (output.window && lasts) {
    const auto [from, to] = *output.window;
    if (!(from >= 0.0 && from < to && to <= time.duration * (1.0 + 1.0e-12)))
      faults.add("output.window", fmt::format("[{:g}, {:g}]", from, to), "not a part of the run",
                 fmt::format("within 0 and {:g} s, the later end last", time.duration));
  }
}

} // namespace

std::vector<Problem> faults_of(const Scene& scene) {
  Faults faults;
  faults.finite("gravity", scene.gravity);
  check_enclosure(faults, scene.enclosure);
  check_granules(faults, scene);
  if (faults.empty()) check_fit(faults, scene);
  check_motion(faults, scene);
  check_controls(faults, scene);
  return faults.take();
}

} // namespace grandamp
