#include "io/study_settings.hpp"

#include "io/plan_report.hpp"
#include "solver/time_step.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grandamp {

namespace {

constexpr double ladder[] = {4, 6, 8, 12, 16, 24, 32, 48, 64};
/// Beyond, looking at all pairs takes longer than the rest of the study.
constexpr std::size_t most_for_all_pairs = 2000;
/// Of Mindlin's tangential stiffness over Hertz's for granules that have no Poisson's ratio.
constexpr double assumed_poisson = 0.35;

class SettingsMaker {
public:
  SettingsMaker(const SceneDocument& document, const std::string& name, const std::vector<std::string>& vary,
                const std::string& isa)
      : document_(document), scene_(document.scene), name_(name), vary_(vary), isa_(isa) {}

  StudySettings make() {
    add_steps();
    if (wanted("integrator"))
      for (const double steps : {4, 6, 8, 12, 16, 32})
        add({.name = fmt::format("verlet-{:g}", steps),
             .group = "integrator",
             .label = fmt::format("T_c/{:g}, velocity Verlet", steps),
             .overrides = with_steps(steps, {"time.integrator=verlet"})});
    if (wanted("precision")) add_mixed();
    if (wanted("policy")) add_policies();
    if (wanted("skin"))
      for (const double skin : {0.05, 0.1, 0.2, 0.4})
        add({.name = fmt::format("skin-{:g}", skin),
             .group = "skin",
             .label = fmt::format("skin {:g} d", skin),
             .overrides = {"verlet.policy=guarded", fmt::format("verlet.skin={:g}", skin)}});
    if (wanted("friction")) add_friction();
    if (wanted("stiffness"))
      for (const double share : {0.1, 0.01, 0.001})
        add({.name = fmt::format("stiffness-{:g}", share),
             .group = "stiffness",
             .label = fmt::format("stiffness reduced to {:g}", share),
             .overrides = softened(share),
             .other_truth = true});
    return std::move(made_);
  }

private:
  bool wanted(const std::string& group) const {
    return vary_.empty() || std::find(vary_.begin(), vary_.end(), group) != vary_.end();
  }

  static std::vector<std::string> with_steps(double steps, std::vector<std::string> others) {
    others.push_back(fmt::format("time.steps_per_contact={:g}", steps));
    return others;
  }

  /// The steps are compared in leapfrog, double and guarded, whatever the scene has.
  void add_steps() {
    const TimeControl& time = scene_.time;
    const bool plain = time.integrator == Integrator::leapfrog && scene_.verlet.policy == ListPolicy::guarded &&
                       !scene_.verlet.skin && !time.step && !time.error;
    bool own = false;
    for (const double steps : ladder) {
      StudySetting setting{.name = fmt::format("steps-{:g}", steps),
                           .group = "steps",
                           .label = fmt::format("T_c/{:g}", steps),
                           .overrides = with_steps(
                               steps, {"time.integrator=leapfrog", "verlet.policy=guarded", "time.precision=double"})};
      setting.own = plain && time.steps_per_contact == steps;
      setting.audited = setting.own && wanted("policy");
      setting.reference = steps == std::end(ladder)[-1];
      own = own || setting.own;
      add(setting);
    }
    if (own) return;
    // Whatever the scene's precision is, its own settings are not overridden.
    add({.name = "own", .group = "steps", .label = "the scene's own", .own = true, .audited = wanted("policy")});
  }

  void add_mixed() {
    try {
      scene_under(document_, name_, {"time.precision=mixed"});
    } catch (const SceneError&) {
      return made_.left_out.emplace_back("mixed precision: this program has none"), void();
    }
    for (const double steps : {4, 8, 16})
      add({.name = fmt::format("mixed-{:g}", steps),
           .group = "precision",
           .label = fmt::format("T_c/{:g}, mixed precision", steps),
           .overrides = with_steps(steps, {"time.precision=mixed"})});
  }

  void add_policies() {
    for (const char* policy : {"predicted", "displacement", "fixed", "none", "all-pairs"}) {
      if (policy == std::string("all-pairs") && document_granules() > most_for_all_pairs) {
        made_.left_out.push_back(fmt::format("policy all-pairs: more than {} granules", most_for_all_pairs));
        continue;
      }
      StudySetting setting{.name = fmt::format("policy-{}", policy),
                           .group = "policy",
                           .label = fmt::format("list policy {}", policy),
                           .overrides = {fmt::format("verlet.policy={}", policy)}};
      setting.audited = policy != std::string("none") && policy != std::string("all-pairs");
      if (policy == std::string("predicted")) setting.label += " (the paper's)";
      add(setting);
    }
  }

  std::size_t document_granules() const {
    std::size_t count = 0;
    for (const Population& population : scene_.populations) count += population.count;
    return count;
  }

  /// Friction by springs in place of Coulomb's capped one, or the other way round.
  void add_friction() {
    if (scene_.contact.friction == FrictionLaw::none)
      return made_.left_out.emplace_back("friction: the scene has none"), void();
    if (scene_.contact.friction == FrictionLaw::spring)
      return add({.name = "coulomb",
                  .group = "friction",
                  .label = "Coulomb friction, capped, in place of springs",
                  .overrides = {"contact.friction=coulomb"},
                  .other_truth = true});
    StudySetting setting{.name = "spring",
                         .group = "friction",
                         .label = "friction by tangential springs in place of Coulomb's cap",
                         .overrides = {"contact.friction=spring"},
                         .other_truth = true};
    const double ratio = 3.0 * (1.0 - assumed_poisson) / (2.0 - assumed_poisson);
    each_constants([&](const std::string& table, const ContactConstants& constants) {
      if (constants.stiffness)
        setting.overrides.push_back(fmt::format("{}.tangential_stiffness={}", table, ratio * *constants.stiffness));
    });
    add(setting);
  }

  template <class Visit> void each_constants(const Visit& visit) const {
    visit("contact.granule", scene_.contact.granule);
    if (scene_.contact.wall) visit("contact.wall", *scene_.contact.wall);
    for (std::size_t k = 0; k < scene_.contact.pairs.size(); ++k)
      visit(fmt::format("contact.pair.{}", k), scene_.contact.pairs[k].constants);
  }

  std::vector<std::string> softened(double share) const {
    std::vector<std::string> overrides;
    const auto scale = [&](const std::string& key, const std::optional<double>& value) {
      if (value) overrides.push_back(fmt::format("{}={}", key, share * *value));
    };
    each_constants([&](const std::string& table, const ContactConstants& constants) {
      scale(table + ".stiffness", constants.stiffness);
      scale(table + ".tangential_stiffness", constants.tangential_stiffness);
      scale(table + ".young", constants.young);
    });
    for (std::size_t a = 0; a < scene_.populations.size(); ++a)
      scale(fmt::format("granules.{}.young", a), scene_.populations[a].young);
    return overrides;
  }

  /// Keeps the setting if the program can run the scene under it.
  void add(StudySetting setting) {
    try {
      const Plan plan = make_plan(scene_under(document_, name_, setting.overrides).scene);
      setting.time_step = plan.time_step;
      setting.steps_per_contact = plan.contact_duration / plan.time_step;
      setting.seconds = estimate_wall_time(plan, isa_, 1).seconds;
      const ContactCalibration calibration =
          calibrate_contacts(plan.scene, make_contact_table(plan.scene), plan.impact_speed);
      setting.contact = calibration.error_at(plan.time_step, plan.scene.time.integrator);
      setting.restitution = calibration.restitution_at(plan.time_step, plan.scene.time.integrator);
    } catch (const SceneError& error) {
      if (setting.reference || setting.own) throw;
      const Problem& first = error.problems().front();
      const std::string reason = first.message.substr(0, first.message.find(" (given by --set"));
      made_.left_out.push_back(fmt::format("{}: {}: {}", setting.label, first.key, reason));
      return;
    }
    made_.settings.push_back(std::move(setting));
  }

  const SceneDocument& document_;
  const Scene& scene_;
  std::string name_;
  const std::vector<std::string>& vary_;
  std::string isa_;
  StudySettings made_;
};

} // namespace

SceneDocument scene_under(const SceneDocument& document, const std::string& name,
                          const std::vector<std::string>& overrides) {
  std::vector<std::string> all = overrides;
  all.emplace_back("output.energy=true"); // the dissipation by mechanism is part of what is compared
  return read_scene_text(document.text, name, all);
}

StudySettings study_settings(const SceneDocument& document, const std::string& name,
                             const std::vector<std::string>& vary, const std::string& isa) {
  return SettingsMaker(document, name, vary, isa).make();
}

} // namespace grandamp
