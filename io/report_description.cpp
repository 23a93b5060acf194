#include "io/json.hpp"
#include "io/progress.hpp"
#include "io/report_data.hpp"
#include "io/report_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <map>
#include <numbers>

namespace grandamp::report {
namespace {

std::string millimetres(double metres) {
  return fmt::format("{:.4g}", 1e3 * metres);
}

std::string enclosure_text(const Enclosure& enclosure) {
  if (enclosure.shape == EnclosureShape::box)
    return fmt::format("box, {} x {} x {} mm inside", millimetres(enclosure.size[0]), millimetres(enclosure.size[1]),
                       millimetres(enclosure.size[2]));
  return fmt::format("cylinder along {}, {} mm wide and {} mm high inside", "xyz"[enclosure.axis],
                     millimetres(enclosure.diameter), millimetres(enclosure.height));
}

std::string granules_text(const Scene& scene) {
  std::string text;
  for (const Population& population : scene.populations) {
    if (population.count == 0) continue;
    text += fmt::format("{}{}{}", text.empty() ? "" : "; ", population.count,
                        population.name.empty() ? "" : " of " + population.name);
    if (population.radii.empty()) text += fmt::format(", {} mm in radius", millimetres(population.radius));
    if (population.masses.empty()) text += ", " + readable(population.mass, "kg") + " each";
  }
  return text.empty() ? "none: the bare structure" : text;
}

std::string structure_text(const Structure& structure) {
  if (!(structure.mass > 0.0)) return "as in the scene below";
  const Vector3& d = structure.direction;
  const double frequency = std::sqrt(structure.stiffness / structure.mass) / (2.0 * std::numbers::pi);
  const double critical = 2.0 * std::sqrt(structure.stiffness * structure.mass);
  std::string text =
      fmt::format("mass {:.6g} kg, stiffness {:.6g} N/m, damping {:.6g} N s/m, along ({:.3g}, {:.3g}, {:.3g})",
                  structure.mass, structure.stiffness, structure.damping, d[0], d[1], d[2]);
  if (structure.stiffness > 0.0)
    text += fmt::format("; bare {:.4g} Hz, damping ratio {:.3g} %", frequency, 100.0 * structure.damping / critical);
  return text;
}

std::string excitation_text(const Scene& scene) {
  const Excitation& excitation = scene.excitation;
  if (excitation.kind == ExcitationKind::none) return scene.structure ? "none: free vibration" : "none";
  if (excitation.kind == ExcitationKind::harmonic) {
    const double force = excitation.force.value_or(
        scene.structure ? scene.structure->stiffness * excitation.static_deflection.value_or(not_known) : not_known);
    return fmt::format("harmonic force of {} at {:.6g} Hz", readable(force, "N"), excitation.frequency);
  }
  if (excitation.kind == ExcitationKind::prescribed) {
    if (excitation.velocity) return fmt::format("the enclosure moves at {}", readable(*excitation.velocity, "m/s"));
    return fmt::format("the enclosure moves by {} at {:.6g} Hz", readable(excitation.amplitude, "m"),
                       excitation.frequency);
  }
  return "as in the scene below";
}

/// Amplitude of the structure alone under its force, and with `added` mass on it, m.
double closed_form_amplitude(const Scene& scene, double added) {
  if (!scene.structure || scene.excitation.kind != ExcitationKind::harmonic || !(scene.structure->mass > 0.0))
    return not_known;
  const Structure& structure = *scene.structure;
  const double force =
      scene.excitation.force.value_or(structure.stiffness * scene.excitation.static_deflection.value_or(not_known));
  const double omega = 2.0 * std::numbers::pi * scene.excitation.frequency;
  return force / std::abs(std::complex<double>(structure.stiffness - (structure.mass + added) * omega * omega,
                                               structure.damping * omega));
}

class Cards {
public:
  void add(std::string_view name, const std::string& value, std::string_view note = {}) {
    html_ += fmt::format("<div class=\"card\"><dt>{}</dt><dd>{}</dd>", escaped(name), escaped(value));
    if (!note.empty()) html_ += fmt::format("<dd class=\"note\">{}</dd>", escaped(note));
    html_ += "</div>\n";
  }
  std::string html() const { return "<dl class=\"cards\">\n" + html_ + "</dl>\n"; }

private:
  std::string html_;
};

std::string joined(const Json& names) {
  std::string text;
  for (const auto& name : names)
    if (name.is_string()) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text;
}

} // namespace

void add_key_numbers(Page& page, const RunFacts& run) {
  const auto of = [&run](std::string_view path) { return number(run.summary, path); };
  Cards cards;
  const double amplitude = of("structure/amplitude");
  if (run.summary.contains("structure")) {
    const std::array<double, 2> window = run.window();
    cards.add("Amplitude", readable(amplitude, "m"),
              fmt::format("half the peak-to-peak, mean over {:.4g} to {:.4g} s", window[0], window[1]));
    cards.add("rms displacement", readable(of("structure/rms_displacement"), "m"),
              fmt::format("peak {}", readable(of("structure/peak_displacement"), "m")));
    if (run.scene && run.plan) {
      const double bare = closed_form_amplitude(*run.scene, 0.0);
      if (std::isfinite(bare) && run.plan->granules > 0)
        cards.add("Against the bare structure",
                  fmt::format("{:+.1f} %", std::round(1000.0 * (amplitude / bare - 1.0)) / 10.0 + 0.0),
                  fmt::format("which swings by {} here, with the granules as added mass by {}", readable(bare, "m", 3),
                              readable(closed_form_amplitude(*run.scene, run.plan->damper.granule_mass), "m", 3)));
    }
  }
  double dissipated = 0.0;
  for (const char* name : {"normal_granule", "normal_wall", "friction_granule", "friction_wall"})
    dissipated += of(std::string("energy/") + name);
  if (std::isfinite(dissipated)) {
    const double damper = of("energy/structural_damping");
    cards.add("Lost in the granules", readable(dissipated, "J"),
              dissipated + damper > 0.0 && run.summary.contains("structure")
                  ? fmt::format("{:.3g} % of all losses", 100.0 * dissipated / (dissipated + damper))
                  : std::string());
    cards.add("Energy balance", fmt::format("{:.2g} %", 100.0 * of("energy/residual")),
              "what is left of it at the end");
  }
  if (run.plan && std::isfinite(run.plan->damper.mass_ratio))
    cards.add("Mass ratio", fmt::format("{:.3g}", run.plan->damper.mass_ratio), "granules over structure");
  if (run.plan && std::isfinite(run.plan->damper.fill_fraction) && run.plan->granules > 0)
    cards.add("Fill", fmt::format("{:.3g} %", 100.0 * run.plan->damper.fill_fraction), "of the enclosure is solid");
  page.add(cards.html());
}

void add_description(Page& page, const RunFacts& run) {
  const auto of = [&run](std::string_view path) { return number(run.summary, path); };
  page.section("run", "What was run");
  if (!run.scene)
    page.add(
        "<p class=\"flag\">This version of grandamp does not read the scene, which is shown below as text alone: its "
        "granules cannot be drawn, nor its numbers checked against it.</p>\n");
  Facts entries;
  if (run.scene) {
    const Scene& scene = *run.scene;
    entries.emplace_back("Enclosure", enclosure_text(scene.enclosure));
    entries.emplace_back("Granules", granules_text(scene));
    entries.emplace_back("Structure",
                         scene.structure ? structure_text(*scene.structure) : "none: the enclosure is held or led");
    entries.emplace_back("Excitation", excitation_text(scene));
    if (run.plan && std::isfinite(run.plan->damper.acceleration))
      entries.emplace_back("Acceleration",
                           fmt::format("{:.3g} g at most, the bare enclosure", run.plan->damper.acceleration));
  }
  if (!run.summary.is_null()) {
    entries.emplace_back("Effects", joined(run.summary.value("effects", Json::array())));
    entries.emplace_back("Left out", joined(run.summary.value("effects_left_out", Json::array())));
  } else if (run.plan) {
    entries.emplace_back("Effects", fmt::format("{}", fmt::join(run.plan->effects, ", ")));
    entries.emplace_back("Left out", fmt::format("{}", fmt::join(run.plan->effects_left_out, ", ")));
  }
  std::string why = text(run.summary, "step_choice/reason");
  if (why.empty() && run.plan) why = run.plan->time_step_reason;
  const double step = run.summary.is_null() ? (run.plan ? run.plan->time_step : not_known) : of("time_step");
  entries.emplace_back("Step", readable(step, "s") + (why.empty() ? "" : ": " + why));
  if (!run.summary.is_null()) {
    entries.emplace_back("Simulated", fmt::format("{} in {:.0f} steps", readable(of("duration"), "s"), of("steps")));
    entries.emplace_back("Machine",
                         fmt::format("{}, {:.0f} thread{}, {}; {} of wall time; grandamp {}", text(run.summary, "isa"),
                                     of("threads"), of("threads") == 1.0 ? "" : "s", text(run.summary, "precision"),
                                     readable_seconds(of("wall_time")), text(run.summary, "version")));
  }
  page.add(facts(entries));
}

} // namespace grandamp::report
