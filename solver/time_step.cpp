#include "solver/time_step.hpp"

#include "solver/errors.hpp"
#include "solver/excitation_signal.hpp"
#include "solver/impact_speed.hpp"
#include "solver/measures.hpp"
#include "solver/several_modes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace grandamp {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using std::numbers::pi;

/// Some granules of about one radius: none of them is lighter than `mass` or larger than `radius`.
struct GranuleClass {
  std::size_t population;
  double radius;
  double mass;
};

/// The granules in classes a few percent wide. Taking a population's lightest and its largest granule for one would be
/// as safe, but a file with a 1:20 spread would then pay for a granule that it does not hold.
std::vector<GranuleClass> granule_classes(const Scene& scene) {
  std::vector<GranuleClass> classes;
  for (std::size_t a = 0; a < scene.populations.size(); ++a) {
    const Population& population = scene.populations[a];
    if (population.count == 0) continue;
    if (population.radii.empty() && population.masses.empty()) {
      classes.push_back({a, population.radius, population.mass});
      continue;
    }
    double smallest = infinity, largest = 0.0;
    for (std::size_t i = 0; i < population.count; ++i) {
      smallest = std::min(smallest, radius_of(population, i));
      largest = std::max(largest, radius_of(population, i));
    }
    constexpr std::size_t bins = 64;
    std::vector<GranuleClass> binned(bins, {a, 0.0, infinity});
    const double width = std::log(largest / smallest) / static_cast<double>(bins);
    for (std::size_t i = 0; i < population.count; ++i) {
      const double place = width > 0.0 ? std::floor(std::log(radius_of(population, i) / smallest) / width) : 0.0;
      GranuleClass& bin = binned[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)))];
      bin.radius = std::max(bin.radius, radius_of(population, i));
      bin.mass = std::min(bin.mass, mass_of(population, i));
    }
    std::copy_if(binned.begin(), binned.end(), std::back_inserter(classes),
                 [](const GranuleClass& bin) { return bin.radius > 0.0; });
  }
  return classes;
}

/// Area of the walls that push along the enclosure's direction of motion, each weighted by (normal . direction)^2, m^2.
double pushing_area(const Enclosure& enclosure, const Vector3& direction) {
  const auto square = [](double a) { return a * a; };
  if (enclosure.shape == EnclosureShape::box) {
    const Vector3& l = enclosure.size;
    return 2.0 * (l[1] * l[2] * square(direction[0]) + l[0] * l[2] * square(direction[1]) +
                  l[0] * l[1] * square(direction[2]));
  }
  const double along = square(direction[static_cast<std::size_t>(enclosure.axis)]);
  const double side = pi * enclosure.diameter * enclosure.height * 0.5 * (1.0 - along);
  return side + 0.5 * pi * square(enclosure.diameter) * along;
}

/// What moves in a contact of a granule with a wall that the structure carries. N granules of mass m that press on the
/// mass M together swing against it with the square k (1/m + N/M): as if each had a wall of mass M / N to itself. N is
/// at most what fits side by side on the walls (hexagons of 2 sqrt(3) r^2 each), so that a structure far lighter than
/// its granules gets the small step that it needs, and a heavy one loses nothing.
double effective_mass_at_wall(const Scene& scene, const GranuleClass& granule, std::size_t granules) {
  if (!scene.structure) return granule.mass;
  double area = pushing_area(scene.enclosure, scene.structure->direction);
  if (has_several_modes(scene)) // in whatever direction most walls push
    for (const Vector3& axis : {Vector3{1.0, 0.0, 0.0}, Vector3{0.0, 1.0, 0.0}, Vector3{0.0, 0.0, 1.0}})
      area = std::max(area, pushing_area(scene.enclosure, axis));
  const double fit = area / (2.0 * std::sqrt(3.0) * granule.radius * granule.radius);
  // Even a wall that only slides past carries the one contact that is there.
  const double sharing = std::max(1.0, std::min(fit, static_cast<double>(granules)));
  return 1.0 / (1.0 / granule.mass + sharing / fastest_oscillator(*scene.structure).mass);
}

struct StiffestContact {
  double unit_duration = infinity; ///< T_c at 1 m/s, s
  std::string name;
  double damping_time = infinity;        ///< least effective mass over normal damping (linear), s
  double overdamping = 1.0;              ///< largest alpha over that of critical damping, sqrt(5); 1 where it is less
  double alpha = 0.0;                    ///< largest (Tsuji)
  double unit_spring_time = infinity;    ///< 1/omega of the stiffest tangential spring at the overlap of 1 m/s, s
  double spring_damping_time = infinity; ///< least effective mass over tangential damping, s
  std::vector<ContactKind> kinds;        ///< every law, by the contact of it that lasts shortest
};

void keep_shortest(std::vector<ContactKind>& kinds, ContactKind&& kind) {
  const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const ContactKind& other) {
    return other.wall == kind.wall && other.law == kind.law;
  });
  if (known == kinds.end())
    kinds.push_back(std::move(kind));
  else if (kind.duration < known->duration)
    *known = std::move(kind);
}

std::string name_of(const Scene& scene, std::size_t population) {
  const std::string& name = scene.populations[population].name;
  return name.empty() ? fmt::format("granules.{}", population) : name;
}

StiffestContact stiffest_contact(const Scene& scene, const ContactTable& contacts) {
  StiffestContact stiffest;
  const std::size_t granules = granule_count(scene);
  const auto consider = [&](const ContactLaw& law, bool wall, double mass, double reduced_radius,
                            const std::string& name) {
    const double duration = hertz_contact_duration(mass, law.stiffness_coefficient * std::sqrt(reduced_radius), 1.0);
    if (duration < stiffest.unit_duration) {
      stiffest.unit_duration = duration;
      stiffest.name = name;
    }
    keep_shortest(stiffest.kinds, {law, wall, mass, reduced_radius, duration, name});
    if (scene.contact.damping == NormalDamping::linear && law.normal_damping > 0.0)
      stiffest.damping_time = std::min(stiffest.damping_time, mass / law.normal_damping);
    if (scene.contact.damping == NormalDamping::tsuji) {
      stiffest.overdamping = std::max(stiffest.overdamping, law.alpha / std::sqrt(5.0));
      stiffest.alpha = std::max(stiffest.alpha, law.alpha);
    }
    const double slip_mass = scene.contact.rotation ? 2.0 / 7.0 * mass : mass;
    if (law.tangential_stiffness_coefficient > 0.0) {
      const double normal = law.stiffness_coefficient * std::sqrt(reduced_radius);
      const double overlap = std::pow(1.25 * mass / normal, 0.4);
      const double tangential = law.tangential_stiffness_coefficient * std::sqrt(reduced_radius * overlap);
      stiffest.unit_spring_time = std::min(stiffest.unit_spring_time, std::sqrt(slip_mass / tangential));
    }
    if (law.tangential_damping > 0.0)
      stiffest.spring_damping_time = std::min(stiffest.spring_damping_time, slip_mass / law.tangential_damping);
  };
  const std::vector<GranuleClass> classes = granule_classes(scene);
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const GranuleClass& a = classes[i];
    consider(contacts.wall[a.population], true, effective_mass_at_wall(scene, a, granules), a.radius,
             name_of(scene, a.population) + " against the wall");
    for (std::size_t j = 0; j <= i && granules > 1; ++j) {
      const GranuleClass& b = classes[j];
      consider(contacts.between(a.population, b.population), false, a.mass * b.mass / (a.mass + b.mass),
               a.radius * b.radius / (a.radius + b.radius),
               name_of(scene, a.population) + " against " + name_of(scene, b.population));
    }
  }
  return stiffest;
}

[[noreturn]] void refuse(const std::string& key, double value, const std::string& message, const std::string& allowed) {
  throw SceneError(Problem{key, fmt::format("{:.4g}", value), message, allowed});
}

/// duration in whole steps of at most `longest`.
void divide(TimeStep& result, double duration, double longest) {
  // A step that divides the duration but for rounding is not made shorter for it.
  const double steps = std::max(1.0, std::ceil(duration / longest * (1.0 - 1.0e-12)));
  if (!(steps < 1.0e15))
    refuse("time.duration", duration, fmt::format("takes more than 1e15 steps of {:.3g} s", longest),
           "a shorter duration");
  result.steps = static_cast<std::int64_t>(steps);
  result.step = duration / steps;
}

void take_given_step(TimeStep& result, const Scene& scene, double longest, const std::string& because) {
  const double step = *scene.time.step;
  const double steps = std::max(1.0, std::round(scene.time.duration / step));
  if (!(steps < 1.0e15)) refuse("time.step", step, "makes more than 1e15 steps", "a longer step");
  result.steps = static_cast<std::int64_t>(steps);
  result.step = scene.time.duration / steps;
  if (result.step > longest * (1.0 + 1.0e-9))
    refuse("time.step", step, "unstable: " + because, fmt::format("at most {:.4g} s", longest));
}

/// An explicit bound on the step and where it comes from.
struct Bound {
  double step;
  std::string reason;
};

void step_without_granules(TimeStep& result, const Scene& scene, const Bound& structure) {
  if (scene.time.step) {
    take_given_step(result, scene, structure.step, structure.reason);
    result.reason = "time.step, a whole number of times in the duration; no granules";
    return;
  }
  double longest = scene.output.history_interval > 0.0 ? scene.output.history_interval : scene.time.duration;
  result.reason = "the history interval; no granules, and the structure's solution is exact at any step";
  const auto bound = [&](double period, const char* whose) {
    if (period / 1000.0 >= longest) return;
    longest = period / 1000.0;
    result.reason = fmt::format("a thousandth of the {} period, {:.4g} s; no granules", whose, period);
  };
  if (scene.excitation.kind != ExcitationKind::none && scene.excitation.frequency > 0.0)
    bound(1.0 / scene.excitation.frequency, "forcing");
  if (const double highest = highest_frequency(scene.excitation); highest > 0.0)
    bound(1.0 / highest, "shortest forcing");
  const Oscillator fastest = scene.structure ? fastest_oscillator(*scene.structure) : Oscillator{};
  if (fastest.stiffness > 0.0) bound(2.0 * pi * std::sqrt(fastest.mass / fastest.stiffness), "natural");
  if (structure.step < longest) {
    longest = structure.step;
    result.reason = structure.reason;
  }
  divide(result, scene.time.duration, longest);
}

/// The step with T_c over `per_contact`, or the scene's own.
TimeStep step_over(double per_contact, TimeStep result, const Scene& scene, const StiffestContact& stiffest,
                   const Bound& structure, const std::string& why) {
  // A third of a contact is where leapfrog still hangs together; the dampings' bounds are half of what is chosen
  // freely.
  Bound stable{result.contact_duration / 3.0,
               fmt::format("a contact of {} lasts {:.4g} s at {:.3g} m/s, and a third of it is the most", stiffest.name,
                           result.contact_duration, result.impact_speed)};
  Bound chosen{result.contact_duration / per_contact,
               fmt::format("T_c = {:.4g} s of {}, closing at {:.3g} m/s ({}), over {:g}", result.contact_duration,
                           stiffest.name, result.impact_speed, why, per_contact)};
  const auto bound = [](Bound& of, double step, const std::string& reason) {
    if (step < of.step) of = {step, reason};
  };
  // Linear damping is taken from the velocity half a step before: one contact alone bears 2 m/c, a granule among twelve
  // (4 c/m along any line, twice that against its neighbours) a quarter of it.
  bound(stable, 0.5 * stiffest.damping_time, "the contacts' normal damping is too strong for it");
  bound(chosen, 0.25 * stiffest.damping_time,
        "a quarter of effective mass over normal damping, which is stricter than T_c");
  // So does Tsuji's, once it is beyond critical, which only contacts without tension can be.
  bound(stable, stable.step / stiffest.overdamping, "the contacts' normal damping is too strong for it");
  bound(chosen, chosen.step / stiffest.overdamping, chosen.reason + ", less for damping beyond critical");
  // Verlet's forces see velocities half a step ahead: damping that takes the share a of a velocity in a step grows
  // beyond a = 1, where leapfrog bears 2. At its deepest one contact takes 3.3 alpha dt / T_c, a granule among twelve
  // four times that.
  if (scene.time.integrator == Integrator::verlet && stiffest.alpha > 0.0) {
    bound(stable, result.contact_duration / (4.0 * stiffest.alpha),
          "the contacts' normal damping is too strong for it under verlet");
    bound(chosen, result.contact_duration / (14.0 * stiffest.alpha),
          "T_c over 14 alpha, the damping's bound under verlet, which is stricter than steps_per_contact");
  }
  // One contact's spring bears 2/omega; a granule among twelve half of it.
  const double spring_time = contact_duration_at(stiffest.unit_spring_time, 1.0, result.impact_speed);
  bound(stable, spring_time, "the contacts' tangential springs are too stiff for it");
  bound(chosen, spring_time / 1.1, "1/omega of the stiffest tangential spring, over 1.1, which is stricter than T_c");
  bound(stable, 0.5 * stiffest.spring_damping_time, "the contacts' tangential damping is too strong for it");
  bound(chosen, 0.25 * stiffest.spring_damping_time,
        "a quarter of effective mass over tangential damping, which is stricter than T_c");
  bound(stable, structure.step, structure.reason);
  bound(chosen, structure.step, structure.reason);
  // The reaction is held over a step: steps near half the structure's own period would resonate with the kicks.
  const Oscillator fastest = scene.structure ? fastest_oscillator(*scene.structure) : Oscillator{};
  if (fastest.stiffness > 0.0) {
    const double period = 2.0 * pi * std::sqrt(fastest.mass / fastest.stiffness);
    bound(stable, period / 4.0, "the structure's natural period wants four steps at least");
    bound(chosen, period / 8.0,
          fmt::format("an eighth of the structure's natural period, {:.4g} s, which is stricter than T_c", period));
  }

  if (scene.time.step) {
    take_given_step(result, scene, stable.step, stable.reason);
    result.reason = fmt::format("time.step, a whole number of times in the duration: {:.3g} steps in T_c = {:.4g} s of "
                                "{}, closing at {:.3g} m/s ({})",
                                result.contact_duration / result.step, result.contact_duration, stiffest.name,
                                result.impact_speed, why);
    return result;
  }
  if (per_contact < 3.0) refuse("time.steps_per_contact", per_contact, "unstable", "at least 3");
  divide(result, scene.time.duration, chosen.step);
  result.reason = chosen.reason;
  return result;
}

} // namespace

double hertz_contact_duration(double effective_mass, double stiffness, double closing_speed) {
  return 3.2180 * std::pow(effective_mass * effective_mass / (stiffness * stiffness * closing_speed), 0.2);
}

double contact_duration_at(double contact_duration, double its_speed, double closing_speed) {
  return contact_duration * std::pow(its_speed / closing_speed, 0.2);
}

ContactCalibration calibrate_contacts(const Scene& scene, const ContactTable& contacts, double impact_speed) {
  return {scene.contact, stiffest_contact(scene, contacts).kinds, impact_speed};
}

namespace {

/// The structure is first taken half a step back by its exact solution, which grows as exp(c h / M) in that direction.
/// And what is no sine is put piece by piece: so many pieces to a step, and no more.
Bound bound_by_structure(const Scene& scene) {
  Bound structure{infinity, ""};
  if (!scene.structure) return structure;
  const auto bound = [&structure](double step, const char* reason) {
    if (step < structure.step) structure = {step, reason};
  };
  const Oscillator s = fastest_oscillator(*scene.structure);
  if (s.damping > 0.0) bound(4.0 * s.mass / s.damping, "four times the structure's decay time, mass over damping");
  const Excitation& e = scene.excitation;
  if (const double highest = highest_frequency(e); highest > 0.0) {
    if (granule_count(scene) > 0)
      bound(0.125 / highest, "an eighth of the shortest forcing period");
    else
      bound(64.0 / highest, "64 of the shortest forcing periods");
  }
  if (is_motion_table(e))
    for (std::size_t k = 0; k + 1 < e.times.size(); ++k)
      bound(1000.0 * (e.times[k + 1] - e.times[k]), "a thousand rows of the table");
  if (s.stiffness > 0.0 && (is_motion_table(e) || make_force_signal(scene)))
    bound(500.0 * 2.0 * pi * std::sqrt(s.mass / s.stiffness), "500 of the structure's natural periods");
  return structure;
}

} // namespace

TimeStep choose_time_step(const Scene& scene, const ContactTable& contacts) {
  TimeStep result;
  const Bound structure = bound_by_structure(scene);
  if (granule_count(scene) == 0) {
    step_without_granules(result, scene, structure);
    return result;
  }

  std::string why;
  result.estimated = !scene.time.impact_speed;
  if (scene.time.impact_speed) {
    result.impact_speed = *scene.time.impact_speed;
    why = "as given";
  } else {
    const ImpactSpeed estimate = estimate_impact_speed(scene);
    result.impact_speed = estimate.speed;
    why = estimate.reason;
  }
  const StiffestContact stiffest = stiffest_contact(scene, contacts);
  result.contact_duration = contact_duration_at(stiffest.unit_duration, 1.0, result.impact_speed);
  if (!scene.time.error) return step_over(scene.time.steps_per_contact, result, scene, stiffest, structure, why);

  const auto at = [&](double steps) { return step_over(steps, result, scene, stiffest, structure, why); };
  const StepChoice choice =
      choose_steps(scene, stiffest.kinds, result.impact_speed, [&](double steps) { return at(steps).step; });
  TimeStep chosen = at(choice.steps_per_contact);
  chosen.reason += ": " + choice.reason();
  chosen.choice = choice;
  return chosen;
}

} // namespace grandamp
