#include "io/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grandamp {

namespace {

/// At sqrt(5) the restitution is 0.
constexpr double largest_alpha = 2.23606797749978969;

class ContactReader {
public:
  ContactReader(TableReader& root, Scene& scene, GranulesRead& granules)
      : table_(root.reading(), root.table("contact"), "contact"), contact_(scene.contact), scene_(scene),
        granules_(granules), faulty_(root.has("contact") && !table_.exists()) {}

  void read() {
    if (faulty_) return;
    read_laws();
    TableReader granule(table_.reading(), table_.table("granule"), "contact.granule");
    TableReader wall(table_.reading(), table_.table("wall"), "contact.wall");
    read_pairs();
    const bool covered = pairs_cover_all(wall.exists());
    if (!table_.has("granule") && granules_.any && !covered)
      table_.missing("granule", "how granules touch each other", "a table [contact.granule]");
    if (granule.exists()) read_constants(granule, contact_.granule);
    if (wall.exists()) {
      contact_.wall.emplace();
      read_constants(wall, *contact_.wall);
      read_wall_material(wall, *contact_.wall);
    }
    if (granule.exists() || (covered && !table_.has("granule"))) check_material(granule, wall);
    for (TableReader& pair : pairs_) pair.finish();
    granule.finish();
    wall.finish();
    table_.finish();
  }

private:
  void read_laws() {
    const auto damping = table_.choice<NormalDamping>(
        "damping", {{"tsuji", NormalDamping::tsuji}, {"linear", NormalDamping::linear}, {"none", NormalDamping::none}});
    damping_known_ = damping || !table_.has("damping");
    contact_.damping = damping.value_or(NormalDamping::tsuji);
    const auto friction = table_.choice<FrictionLaw>(
        "friction", {{"coulomb", FrictionLaw::coulomb}, {"spring", FrictionLaw::spring}, {"none", FrictionLaw::none}});
    friction_known_ = friction || !table_.has("friction");
    contact_.friction = friction.value_or(FrictionLaw::coulomb);
    contact_.tension = table_.flag("tension").value_or(true);
    contact_.rotation = table_.flag("rotation").value_or(true);
  }

  void read_pairs() {
    for (const toml::table* table : table_.tables("pair")) {
      TableReader& pair = pairs_.emplace_back(table_.reading(), table, fmt::format("contact.pair.{}", pairs_.size()));
      PairContact& contact = contact_.pairs.emplace_back();
      if (!pair.has("between"))
        pair.missing("between", "whose contact this is", "two names of populations, or one and \"wall\"");
      contact.between = pair.two_names("between").value_or(std::array<std::string, 2>{});
      check_between(pair, contact.between);
      read_constants(pair, contact.constants);
      if (contact.between[0] == "wall" || contact.between[1] == "wall")
        read_wall_material(pair, contact.constants);
      else
        for (const std::string_view key : {"young", "poisson"})
          pair.idle(key, "two populations have their own, in [[granules]]", "no " + std::string(key));
    }
  }

  void check_between(TableReader& pair, const std::array<std::string, 2>& between) {
    if (between[0].empty() && between[1].empty()) return;
    for (const std::string& name : between)
      if (name != "wall" && (name.empty() || std::none_of(scene_.populations.begin(), scene_.populations.end(),
                                                          [&](const Population& p) { return p.name == name; })))
        return pair.wrong("between", fmt::format("no population has the name \"{}\"", name), names());
    if (between[0] == "wall" && between[1] == "wall")
      pair.wrong("between", "the wall does not touch itself", "a population and \"wall\", or two populations");
    for (std::size_t k = 0; k + 1 < pairs_.size(); ++k) {
      const std::array<std::string, 2>& other = contact_.pairs[k].between;
      if (other == between || (other[0] == between[1] && other[1] == between[0]))
        pair.wrong("between", fmt::format("contact.pair.{} is between the same two", k), "each two of them once");
    }
  }

  std::string names() const {
    std::string list;
    for (const Population& population : scene_.populations)
      if (!population.name.empty()) list += fmt::format("\"{}\", ", population.name);
    return list + "\"wall\"";
  }

  /// The table between two; null: none of [[contact.pair]].
  const TableReader* pair_between(const std::string& a, const std::string& b) const {
    for (std::size_t k = 0; k < pairs_.size() && !a.empty() && !b.empty(); ++k) {
      const std::array<std::string, 2>& between = contact_.pairs[k].between;
      if ((between[0] == a && between[1] == b) || (between[0] == b && between[1] == a)) return &pairs_[k];
    }
    return nullptr;
  }

  /// Whether nothing is left for [contact.granule] to say.
  bool pairs_cover_all(bool wall_is_given) const {
    for (const Population& a : scene_.populations) {
      if (!wall_is_given && pair_between(a.name, "wall") == nullptr) return false;
      for (const Population& b : scene_.populations)
        if (pair_between(a.name, b.name) == nullptr) return false;
    }
    return true;
  }

  void read_constants(TableReader& table, ContactConstants& constants) {
    constants.stiffness = table.number("stiffness", positive);
    constants.reference_radius = table.number("reference_radius", positive);
    if (table.has("stiffness") && !table.has("reference_radius"))
      table.missing("reference_radius", "the radius that the stiffness holds for", "a radius in m, above 0");
    if (!table.has("stiffness"))
      table.idle("reference_radius", "it goes with a stiffness, and there is none", "both of them, or neither");
    if (damping_known_)
      read_damping(table, constants);
    else
      for (const std::string_view key : {"restitution", "alpha", "normal_damping"}) table.pass(key);
    if (friction_known_)
      read_friction(table, constants);
    else
      for (const std::string_view key : {"friction", "tangential_stiffness", "tangential_damping"}) table.pass(key);
  }

  void read_damping(TableReader& table, ContactConstants& constants) {
    const auto idle = [&table](std::string_view key, const std::string& why, const std::string& allowed) {
      table.idle(key, "contact.damping is " + why, allowed);
    };
    switch (contact_.damping) {
    case NormalDamping::tsuji: {
      idle("normal_damping", "\"tsuji\"", "restitution or alpha; or damping = \"linear\"");
      const std::string_view key = table.one_of({"restitution", "alpha"});
      if (key.empty() && granules_.any)
        table.missing("restitution", "needed by damping = \"tsuji\"", "restitution above 0 and at most 1, or alpha");
      if (key == "restitution") constants.restitution = table.number(key, {0.0, 1.0, false, true});
      // A contact that only pushes bears any alpha.
      if (key == "alpha")
        constants.alpha = table.number(key, contact_.tension ? Range{0.0, largest_alpha, true, false} : not_negative);
      break;
    }
    case NormalDamping::linear:
      for (const std::string_view key : {"restitution", "alpha"})
        idle(key, "\"linear\", whose restitution depends on the speed", "normal_damping; or damping = \"tsuji\"");
      if (!table.has("normal_damping") && granules_.any)
        table.missing("normal_damping", "needed by damping = \"linear\"", "a number at least 0, in N s/m");
      constants.normal_damping = table.number("normal_damping", not_negative);
      break;
    case NormalDamping::none:
      for (const std::string_view key : {"restitution", "alpha", "normal_damping"})
        idle(key, "\"none\": a contact gives back all its energy", "none of restitution, alpha, normal_damping");
      break;
    }
  }

  void read_friction(TableReader& table, ContactConstants& constants) {
    if (contact_.friction == FrictionLaw::none) {
      for (const std::string_view key : {"friction", "tangential_stiffness", "tangential_damping"})
        table.idle(key, "contact.friction is \"none\"", "no such key; or contact.friction = \"coulomb\"");
      return;
    }
    const bool spring = contact_.friction == FrictionLaw::spring;
    if (!table.has("friction") && granules_.any)
      table.missing("friction", fmt::format("needed by contact.friction = \"{}\"", spring ? "spring" : "coulomb"),
                    "a number at least 0");
    constants.friction = table.number("friction", not_negative);
    if (!spring) {
      for (const std::string_view key : {"tangential_stiffness", "tangential_damping"})
        table.idle(key, "only friction = \"spring\" has it", "friction; or contact.friction = \"spring\"");
      return;
    }
    if (!table.has("stiffness"))
      table.idle("tangential_stiffness", "it goes with a stiffness; young and poisson give the tangential one, too",
                 "stiffness and tangential_stiffness, or neither");
    else if (!table.has("tangential_stiffness") && granules_.any)
      table.missing("tangential_stiffness", "needed by contact.friction = \"spring\" beside a stiffness",
                    "a number at least 0, in N/m^1.5, of two granules of reference_radius");
    constants.tangential_stiffness = table.number("tangential_stiffness", not_negative);
    constants.tangential_damping = table.number("tangential_damping", not_negative);
  }

  void read_wall_material(TableReader& wall, ContactConstants& constants) {
    if (wall.has("stiffness")) {
      for (const std::string_view key : {"young", "poisson"}) {
        if (wall.reading().is_overridden(wall.key_path(key)) &&
            !wall.reading().is_overridden(wall.key_path("stiffness")))
          wall.idle("stiffness", fmt::format("{} is given as well", key), "stiffness, or young and poisson");
        else
          wall.idle(key, "a stiffness is given", "stiffness and reference_radius, or young and poisson");
      }
      return;
    }
    constants.young = wall.number("young", positive);
    constants.poisson = wall.number("poisson", {-1.0, 0.5, false, true});
    if (!granules_.any) return;
    for (const std::string_view key : {"young", "poisson"})
      if (!wall.has(key))
        wall.missing(key, fmt::format("needed as {} has no stiffness", wall.header()),
                     "young and poisson of the wall, or stiffness and reference_radius");
  }

  /// A population's own material is needed where one of its contacts has no stiffness, and does not apply otherwise.
  void check_material(const TableReader& granule, const TableReader& wall) {
    for (std::size_t i = 0; i < granules_.tables.size(); ++i) {
      TableReader& population = granules_.tables[i];
      const std::string lacking = contact_without_stiffness(i, granule, wall);
      for (const std::string_view key : {"young", "poisson"}) {
        if (lacking.empty())
          population.idle(key, "the contacts' stiffnesses are given",
                          "contacts without stiffness, or no " + std::string(key));
        else if (!population.has(key) && scene_.populations[i].count > 0)
          population.missing(key, fmt::format("needed as {} has no stiffness", lacking),
                             key == "young" ? "Young's modulus in Pa, above 0"
                                            : "Poisson's ratio, above -1 and at most 0.5");
      }
    }
    // Hertz: against a flat wall of its own material a granule is sqrt(2) times as stiff as against its like, since
    // R = r there and r/2 between two. Without [contact.wall] the solver's contact table makes it so.
  }

  /// The first table without stiffness that population i's contacts are told by; empty: none.
  std::string contact_without_stiffness(std::size_t i, const TableReader& granule, const TableReader& wall) const {
    const std::string& own = scene_.populations[i].name;
    const auto lacks = [](const TableReader& table) { return table.has("stiffness") ? "" : table.header(); };
    for (const Population& other : scene_.populations) {
      const TableReader* pair = pair_between(own, other.name);
      if (std::string table = lacks(pair != nullptr ? *pair : granule); !table.empty()) return table;
    }
    const TableReader* pair = pair_between(own, "wall");
    if (pair != nullptr) return lacks(*pair);
    return wall.exists() ? lacks(wall) : std::string();
  }

  TableReader table_;
  Contact& contact_;
  Scene& scene_;
  GranulesRead& granules_;
  std::vector<TableReader> pairs_;
  bool faulty_;
  bool damping_known_ = true;
  bool friction_known_ = true;
};

} // namespace

void read_contact(TableReader& root, Scene& scene, GranulesRead& granules) {
  ContactReader(root, scene, granules).read();
}

} // namespace grandamp
