#include "solver/material.hpp"

#include "solver/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>

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

/// 1/G* = (2 - nu_i)/G_i + (2 - nu_j)/G_j with G = E / (2 (1 + nu)): Mindlin's contact that does not slip has the
/// tangential stiffness 8 G* sqrt(R d).
double effective_shear_modulus(const Elasticity& i, const Elasticity& j) {
  const auto compliance = [](const Elasticity& of) { return 2.0 * (2.0 - of.poisson) * (1.0 + of.poisson) / of.young; };
  return 1.0 / (compliance(i) + compliance(j));
}

/// Constants of a contact and the table that gave them.
struct Given {
  const ContactConstants* constants;
  std::string table;
};

constexpr const char* wall_name = "wall";

/// Collects every missing constant before it throws, each once.
class Constants {
public:
  explicit Constants(const Scene& scene) : scene_(scene) { check_pairs(); }

  Given of_granules(std::size_t a, std::size_t b) const {
    const std::optional<Given> own = pair(scene_.populations[a].name, scene_.populations[b].name);
    return own.value_or(Given{&scene_.contact.granule, "contact.granule"});
  }

  /// None: the granules' wall of their own material.
  std::optional<Given> of_wall(std::size_t a) const {
    std::optional<Given> own = pair(scene_.populations[a].name, wall_name);
    if (!own && scene_.contact.wall) own = Given{&*scene_.contact.wall, "contact.wall"};
    return own;
  }

  double stiffness_of_granules(const Given& given, std::size_t a, std::size_t b) {
    // k = stiffness sqrt(2 R / reference_radius), so that two granules of reference_radius have `stiffness`.
    if (given.constants->stiffness) return *given.constants->stiffness * std::sqrt(2.0 / reference(given));
    return 4.0 / 3.0 * effective_modulus(material(a), material(b));
  }

  double stiffness_of_wall(const Given& given, std::size_t a) {
    // k = stiffness sqrt(r / reference_radius), and R = r at a wall.
    if (given.constants->stiffness) return *given.constants->stiffness / std::sqrt(reference(given));
    return 4.0 / 3.0 * effective_modulus(material(a), wall_material(given));
  }

  /// C_t, scaled with the radii as the stiffness is; from moduli it is Mindlin's 8 G*.
  double tangential_of_granules(const Given& given, std::size_t a, std::size_t b) {
    if (given.constants->stiffness) return tangential(given) * std::sqrt(2.0 / reference(given));
    return 8.0 * effective_shear_modulus(material(a), material(b));
  }

  double tangential_of_wall(const Given& given, std::size_t a) {
    if (given.constants->stiffness) return tangential(given) / std::sqrt(reference(given));
    return 8.0 * effective_shear_modulus(material(a), wall_material(given));
  }

  void losses(const Given& of, ContactLaw& law) {
    const ContactConstants& given = *of.constants;
    const std::string& table = of.table;
    switch (scene_.contact.damping) {
    case NormalDamping::tsuji:
      if (given.alpha)
        law.alpha = *given.alpha;
      else
        law.alpha =
            alpha_of(require(given.restitution, table + ".restitution", "needed by damping = \"tsuji\" (or alpha)"),
                     table + ".restitution");
      // At alpha = sqrt(5) the restitution is zero: beyond, granules that may pull stick together as no formula of the
      // model foresees.
      if (scene_.contact.tension)
        check(table + ".alpha", law.alpha, law.alpha >= 0.0 && law.alpha < std::sqrt(5.0),
              "at least 0 and below 2.236");
      else
        check(table + ".alpha", law.alpha, law.alpha >= 0.0, "at least 0");
      break;
    case NormalDamping::linear:
      law.normal_damping = require(given.normal_damping, table + ".normal_damping", "needed by damping = \"linear\"");
      check(table + ".normal_damping", law.normal_damping, law.normal_damping >= 0.0, "at least 0");
      break;
    case NormalDamping::none:
      break;
    }
    if (scene_.contact.friction != FrictionLaw::none) {
      const bool spring = scene_.contact.friction == FrictionLaw::spring;
      law.friction = require(given.friction, table + ".friction",
                             fmt::format("needed by friction = \"{}\"", spring ? "spring" : "coulomb"));
      check(table + ".friction", law.friction, law.friction >= 0.0, "at least 0");
    }
    if (scene_.contact.friction == FrictionLaw::spring) {
      law.tangential_damping = given.tangential_damping.value_or(0.0);
      check(table + ".tangential_damping", law.tangential_damping, law.tangential_damping >= 0.0, "at least 0");
    }
  }

  double alpha_of(double restitution, const std::string& key) {
    const bool allowed = restitution > 0.0 && restitution <= 1.0;
    check(key, restitution, allowed, "above 0, at most 1");
    if (!allowed) return 0.0;
    return scene_.contact.tension ? tsuji_alpha(restitution) : tsuji_alpha_without_tension(restitution);
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

  /// Names that are populations', each pair once.
  void check_pairs() {
    const std::vector<PairContact>& pairs = scene_.contact.pairs;
    const auto known = [this](const std::string& name) {
      return name == wall_name || (!name.empty() && std::any_of(scene_.populations.begin(), scene_.populations.end(),
                                                                [&](const Population& p) { return p.name == name; }));
    };
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::array<std::string, 2>& between = pairs[k].between;
      const std::string key = fmt::format("contact.pair.{}.between", k), value = between[0] + ", " + between[1];
      if (!known(between[0]) || !known(between[1]))
        add(key, value, "no population of this name", "names of populations, or \"wall\"");
      else if (between[0] == wall_name && between[1] == wall_name)
        add(key, value, "the wall does not touch itself", "a population and \"wall\"");
      else if (pair(between[0], between[1])->constants != &pairs[k].constants)
        add(key, value, "given twice", "each two of them once");
    }
  }

  /// The first table between the two, in either order.
  std::optional<Given> pair(const std::string& a, const std::string& b) const {
    const std::vector<PairContact>& pairs = scene_.contact.pairs;
    for (std::size_t k = 0; k < pairs.size() && !a.empty() && !b.empty(); ++k) {
      const auto& [first, second] = pairs[k].between;
      if ((first == a && second == b) || (first == b && second == a))
        return Given{&pairs[k].constants, fmt::format("contact.pair.{}", k)};
    }
    return std::nullopt;
  }

  double reference(const Given& given) {
    const double radius = require(given.constants->reference_radius, given.table + ".reference_radius",
                                  "the radius that the stiffness holds for");
    check(given.table + ".reference_radius", radius, radius > 0.0, "above 0");
    check(given.table + ".stiffness", *given.constants->stiffness, *given.constants->stiffness > 0.0, "above 0");
    return radius;
  }

  double tangential(const Given& given) {
    const std::string key = given.table + ".tangential_stiffness";
    const double stiffness =
        require(given.constants->tangential_stiffness, key, "needed by friction = \"spring\" beside a stiffness");
    check(key, stiffness, stiffness >= 0.0, "at least 0");
    return stiffness;
  }

  Elasticity wall_material(const Given& given) {
    const std::string why = fmt::format("needed, as {}.stiffness is left out", given.table);
    const Elasticity wall{require(given.constants->young, given.table + ".young", why),
                          require(given.constants->poisson, given.table + ".poisson", why)};
    check_elasticity(given.table, wall);
    return wall;
  }

  Elasticity material(std::size_t a) {
    const Population& population = scene_.populations[a];
    const std::string key = fmt::format("granules.{}", a);
    const Elasticity elasticity{
        require(population.young, key + ".young", "needed where a contact gives no stiffness"),
        require(population.poisson, key + ".poisson", "needed where a contact gives no stiffness")};
    check_elasticity(key, elasticity);
    return elasticity;
  }

  void check_elasticity(const std::string& table, const Elasticity& of) {
    check(table + ".young", of.young, of.young > 0.0, "above 0");
    check(table + ".poisson", of.poisson, of.poisson > -1.0 && of.poisson <= 0.5, "above -1, at most 0.5");
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

double tsuji_alpha_without_tension(double restitution) {
  if (!(restitution > 0.0 && restitution <= 1.0))
    throw SceneError(Problem{"restitution", fmt::format("{}", restitution), "out of range", "above 0, at most 1"});
  // With s = (2/sqrt 5) d^(5/4) in units of the contact, Eq. (6) is s'' + 2 zeta s' + s = 0, zeta = alpha / sqrt(5), in
  // the plane of speed and s. It starts at s = 0 and ends where the force is none, s'' = 0, at the speed
  //   e = exp(-tan(psi) (pi - 2 psi)), zeta = sin(psi) <= 1; e = exp(-2 eta / tanh(eta)), zeta = cosh(eta) >= 1;
  // both fall with zeta, through exp(-2) where they meet.
  const double wanted = -std::log(restitution);
  if (wanted == 0.0) return 0.0;
  const auto bisected = [wanted](double low, double high, const auto& exponent) {
    for (int k = 0; k < 200; ++k) {
      const double middle = 0.5 * (low + high);
      (exponent(middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  const double zeta =
      wanted < 2.0
          ? std::sin(bisected(0.0, 0.5 * std::numbers::pi,
                              [](double psi) { return std::tan(psi) * (std::numbers::pi - 2.0 * psi); }))
          : std::cosh(bisected(0.0, wanted, [](double eta) { return eta > 0.0 ? 2.0 * eta / std::tanh(eta) : 2.0; }));
  return std::sqrt(5.0) * zeta;
}

ContactTable make_contact_table(const Scene& scene) {
  const std::size_t populations = scene.populations.size();
  ContactTable table{populations, std::vector<ContactLaw>(populations * populations),
                     std::vector<ContactLaw>(populations)};
  Constants constants(scene);
  const bool springs = scene.contact.friction == FrictionLaw::spring;
  std::size_t granules = 0;
  for (const Population& population : scene.populations) granules += population.count;
  for (std::size_t a = 0; a < populations; ++a) {
    if (scene.populations[a].count == 0) continue; // nothing of it ever touches anything
    const std::optional<Given> wall = constants.of_wall(a);
    // A single granule beside a wall that says everything needs no constants of granules among themselves.
    if (granules > 1 || !wall) {
      for (std::size_t b = 0; b < populations; ++b) {
        if (scene.populations[b].count == 0) continue;
        const Given given = constants.of_granules(a, b);
        ContactLaw& law = table.granule[a * populations + b];
        law.stiffness_coefficient = constants.stiffness_of_granules(given, a, b);
        if (springs) law.tangential_stiffness_coefficient = constants.tangential_of_granules(given, a, b);
        constants.losses(given, law);
      }
    }
    if (wall) {
      table.wall[a].stiffness_coefficient = constants.stiffness_of_wall(*wall, a);
      if (springs) table.wall[a].tangential_stiffness_coefficient = constants.tangential_of_wall(*wall, a);
      constants.losses(*wall, table.wall[a]);
    } else {
      // Left out: the flat wall of the granules' own material. E* is then that of two such granules, and so is C.
      table.wall[a] = table.between(a, a);
    }
  }
  constants.throw_if_any();
  return table;
}

} // namespace grandamp
