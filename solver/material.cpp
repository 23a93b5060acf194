#include "solver/material.hpp"

#include "solver/errors.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace grandamp {

namespace {

/// Young's modulus and Poisson's ratio of one partner of a contact.
struct Elasticity {
  double young;
  double poisson;
};

/// E* = E_i E_j / ((1 - nu_i^2) E_j + (1 - nu_j^2) E_i): Eq. (4) with its printed pairing corrected, so that a rigid
/// partner leaves E_i / (1 - nu_i^2). Written with the compliances: an infinite modulus is then no special case.
double effective_modulus(const Elasticity& i, const Elasticity& j) {
  return 1.0 / ((1.0 - i.poisson * i.poisson) / i.young + (1.0 - j.poisson * j.poisson) / j.young);
}

/// Collects every missing constant before it throws, each once.
class Constants {
public:
  explicit Constants(const Scene& scene) : scene_(scene) {}

  double stiffness_of_granules(std::size_t a, std::size_t b) {
    const ContactConstants& given = scene_.contact.granule;
    // k = stiffness sqrt(2 R / reference_radius), so that two granules of reference_radius have `stiffness`.
    if (given.stiffness) return *given.stiffness * std::sqrt(2.0 / reference(given, "contact.granule"));
    return 4.0 / 3.0 * effective_modulus(material(a), material(b));
  }

  double stiffness_of_wall(std::size_t a) {
    // Left out: the flat wall of the granules' own material. E* is then that of two such granules, and so is C.
    if (!scene_.contact.wall) return stiffness_of_granules(a, a);
    const ContactConstants& given = *scene_.contact.wall;
    // k = stiffness sqrt(r / reference_radius), and R = r at a wall.
    if (given.stiffness) return *given.stiffness / std::sqrt(reference(given, "contact.wall"));
    const Elasticity wall{
        require(given.young, "contact.wall.young", "needed, as contact.wall.stiffness is left out"),
        require(given.poisson, "contact.wall.poisson", "needed, as contact.wall.stiffness is left out")};
    check("contact.wall.young", wall.young, wall.young > 0.0, "above 0");
    check("contact.wall.poisson", wall.poisson, wall.poisson > -1.0 && wall.poisson <= 0.5, "above -1, at most 0.5");
    return 4.0 / 3.0 * effective_modulus(material(a), wall);
  }

  void losses(const ContactConstants& given, const std::string& table, ContactLaw& law) {
    switch (scene_.contact.damping) {
    case NormalDamping::tsuji:
      if (given.alpha)
        law.alpha = *given.alpha;
      else
        law.alpha =
            alpha_of(require(given.restitution, table + ".restitution", "needed by damping = \"tsuji\" (or alpha)"),
                     table + ".restitution");
      // At alpha = sqrt(5) the restitution is zero: beyond, granules stick together as no formula of the model
      // foresees.
      check(table + ".alpha", law.alpha, law.alpha >= 0.0 && law.alpha < std::sqrt(5.0), "at least 0 and below 2.236");
      break;
    case NormalDamping::linear:
      law.normal_damping = require(given.normal_damping, table + ".normal_damping", "needed by damping = \"linear\"");
      check(table + ".normal_damping", law.normal_damping, law.normal_damping >= 0.0, "at least 0");
      break;
    case NormalDamping::none:
      break;
    }
    if (scene_.contact.friction == FrictionLaw::coulomb) {
      law.friction = require(given.friction, table + ".friction", "needed by friction = \"coulomb\"");
      check(table + ".friction", law.friction, law.friction >= 0.0, "at least 0");
    }
  }

  double alpha_of(double restitution, const std::string& key) {
    const bool allowed = restitution > 0.0 && restitution <= 1.0;
    check(key, restitution, allowed, "above 0, at most 1");
    return allowed ? tsuji_alpha(restitution) : 0.0;
  }

  void check(const std::string& key, double value, bool allowed, const std::string& range) {
    if (!allowed || !std::isfinite(value)) add(key, fmt::format("{}", value), "out of range", range);
  }

  void throw_if_any() const {
    if (!problems_.empty()) throw SceneError(problems_);
  }

private:
  void add(const std::string& key, const std::string& value, const std::string& message, const std::string& allowed) {
    for (const Problem& known : problems_)
      if (known.key == key) return;
    problems_.push_back({key, value, message, allowed});
  }

  double require(const std::optional<double>& value, const std::string& key, const std::string& why) {
    if (!value) add(key, "", "missing: " + why, "");
    return value.value_or(1.0); // any value will do: throw_if_any() follows
  }

  double reference(const ContactConstants& given, const std::string& table) {
    const double radius =
        require(given.reference_radius, table + ".reference_radius", "the radius that the stiffness holds for");
    check(table + ".reference_radius", radius, radius > 0.0, "above 0");
    check(table + ".stiffness", *given.stiffness, *given.stiffness > 0.0, "above 0");
    return radius;
  }

  Elasticity material(std::size_t a) {
    const Population& population = scene_.populations[a];
    const std::string key = fmt::format("granules.{}", a);
    const Elasticity elasticity{
        require(population.young, key + ".young", "needed where a contact gives no stiffness"),
        require(population.poisson, key + ".poisson", "needed where a contact gives no stiffness")};
    check(key + ".young", elasticity.young, elasticity.young > 0.0, "above 0");
    check(key + ".poisson", elasticity.poisson, elasticity.poisson > -1.0 && elasticity.poisson <= 0.5,
          "above -1, at most 0.5");
    return elasticity;
  }

  const Scene& scene_;
  std::vector<Problem> problems_;
};

} // namespace

double tsuji_alpha(double restitution) {
  if (!(restitution > 0.0 && restitution <= 1.0))
    throw SceneError(Problem{"restitution", fmt::format("{}", restitution), "out of range", "above 0, at most 1"});
  const double logarithm = std::log(restitution);
  return -std::sqrt(5.0) * logarithm / std::hypot(logarithm, std::numbers::pi) + 0.0; // + 0.0: not -0 for e = 1
}

ContactTable make_contact_table(const Scene& scene) {
  const std::size_t populations = scene.populations.size();
  ContactTable table{populations, std::vector<ContactLaw>(populations * populations),
                     std::vector<ContactLaw>(populations)};
  Constants constants(scene);
  std::size_t granules = 0;
  for (const Population& population : scene.populations) granules += population.count;
  for (std::size_t a = 0; a < populations; ++a) {
    if (scene.populations[a].count == 0) continue; // nothing of it ever touches anything
    // A single granule beside a wall that says everything needs no constants of granules among themselves.
    if (granules > 1 || !scene.contact.wall) {
      for (std::size_t b = 0; b < populations; ++b) {
        if (scene.populations[b].count == 0) continue;
        ContactLaw& law = table.granule[a * populations + b];
        law.stiffness_coefficient = constants.stiffness_of_granules(a, b);
        constants.losses(scene.contact.granule, "contact.granule", law);
      }
    }
    table.wall[a].stiffness_coefficient = constants.stiffness_of_wall(a);
    if (scene.contact.wall)
      constants.losses(*scene.contact.wall, "contact.wall", table.wall[a]);
    else
      constants.losses(scene.contact.granule, "contact.granule", table.wall[a]);
  }
  constants.throw_if_any();
  return table;
}

} // namespace grandamp
