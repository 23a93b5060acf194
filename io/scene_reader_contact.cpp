#include "io/scene_reader.hpp"

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
    if (!table_.has("granule") && granules_.any)
      table_.missing("granule", "how granules touch each other", "a table [contact.granule]");
    if (granule.exists()) read_constants(granule, contact_.granule);
    if (wall.exists()) {
      contact_.wall.emplace();
      read_constants(wall, *contact_.wall);
      read_wall_material(wall);
    }
    if (granule.exists()) check_material(granule, wall);
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
        "friction", {{"coulomb", FrictionLaw::coulomb}, {"none", FrictionLaw::none}}, {"spring"});
    friction_known_ = friction || !table_.has("friction");
    contact_.friction = friction.value_or(FrictionLaw::coulomb);
    if (table_.flag("tension") == false) table_.not_yet("tension", "tension = false", "true");
    contact_.rotation = table_.flag("rotation").value_or(true);
    table_.pass("pair");
    if (table_.has("pair"))
      table_.not_yet("pair", "[[contact.pair]]", "[contact.granule] and [contact.wall], the same for all populations");
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
      if (key == "alpha") constants.alpha = table.number(key, {0.0, largest_alpha, true, false});
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
    for (const std::string_view key : {"tangential_stiffness", "tangential_damping"})
      table.idle(key, "only friction = \"spring\" has it, and this version cannot do that yet", "friction");
    if (contact_.friction == FrictionLaw::none) {
      table.idle("friction", "contact.friction is \"none\"", "no coefficient; or contact.friction = \"coulomb\"");
      return;
    }
    if (!table.has("friction") && granules_.any)
      table.missing("friction", "needed by contact.friction = \"coulomb\"", "a number at least 0");
    constants.friction = table.number("friction", not_negative);
  }

  void read_wall_material(TableReader& wall) {
    ContactConstants& constants = *contact_.wall;
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
        wall.missing(key, "needed as [contact.wall] has no stiffness",
                     "young and poisson of the wall, or stiffness and reference_radius");
  }

  /// The granules' own material is needed where a contact has no stiffness, and does not apply where all have one.
  void check_material(const TableReader& granule, const TableReader& wall) {
    const bool pairs = !granule.has("stiffness");
    const bool walls = wall.exists() && !wall.has("stiffness");
    for (std::size_t i = 0; i < granules_.tables.size(); ++i) {
      TableReader& population = granules_.tables[i];
      for (const std::string_view key : {"young", "poisson"}) {
        if (!pairs && !walls)
          population.idle(key, "the contacts' stiffnesses are given",
                          "contacts without stiffness, or no " + std::string(key));
        else if (!population.has(key) && scene_.populations[i].count > 0)
          population.missing(key, fmt::format("needed as [contact.{}] has no stiffness", pairs ? "granule" : "wall"),
                             key == "young" ? "Young's modulus in Pa, above 0"
                                            : "Poisson's ratio, above -1 and at most 0.5");
      }
    }
    // Hertz: against a flat wall of its own material a granule is sqrt(2) times as stiff as against its like, since
    // R = r there and r/2 between two. Without [contact.wall] the solver's contact table makes it so.
  }

  TableReader table_;
  Contact& contact_;
  Scene& scene_;
  GranulesRead& granules_;
  bool faulty_;
  bool damping_known_ = true;
  bool friction_known_ = true;
};

} // namespace

void read_contact(TableReader& root, Scene& scene, GranulesRead& granules) {
  ContactReader(root, scene, granules).read();
}

} // namespace grandamp
