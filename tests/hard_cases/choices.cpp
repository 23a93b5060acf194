#include "tests/hard_cases/choices.hpp"

#include <array>
#include <set>

#include <fmt/format.h>

namespace grandamp::test {

namespace {

template <class Value> struct Level {
  Value value;
  const char* name;
};

// One list per factor; what is added here is in every hard case.
constexpr std::array friction_laws{Level<FrictionLaw>{FrictionLaw::coulomb, "coulomb"},
                                   Level<FrictionLaw>{FrictionLaw::spring, "spring"},
                                   Level<FrictionLaw>{FrictionLaw::none, "none"}};
constexpr std::array precisions{Level<Precision>{Precision::full, "double"},
                                Level<Precision>{Precision::mixed, "mixed"}};
constexpr std::array policies{
    Level<ListPolicy>{ListPolicy::guarded, "guarded"},     Level<ListPolicy>{ListPolicy::displacement, "displacement"},
    Level<ListPolicy>{ListPolicy::none, "none"},           Level<ListPolicy>{ListPolicy::all_pairs, "all-pairs"},
    Level<ListPolicy>{ListPolicy::predicted, "predicted"}, Level<ListPolicy>{ListPolicy::fixed, "fixed"}};
constexpr std::array steps_per_contact{8.0, 16.0};
constexpr std::array integrators{Level<Integrator>{Integrator::leapfrog, "leapfrog"},
                                 Level<Integrator>{Integrator::verlet, "verlet"}};
constexpr std::array<std::uint64_t, 3> seeds{1, 2, 3};

template <class Levels, class Value> const char* name_of(const Levels& levels, Value value) {
  for (const auto& level : levels)
    if (level.value == value) return level.name;
  return "?";
}

} // namespace

std::string told(const Choice& choice) {
  return fmt::format("{}, {}, {}, {:g}, {}, {}", name_of(friction_laws, choice.friction),
                     name_of(precisions, choice.precision), name_of(policies, choice.policy), choice.steps_per_contact,
                     name_of(integrators, choice.integrator), choice.seed);
}

std::vector<std::vector<std::size_t>>
pairwise_rows(const std::vector<std::size_t>& levels,
              const std::function<bool(const std::vector<std::size_t>&)>& allowed) {
  const std::size_t factors = levels.size();
  std::vector<std::vector<std::size_t>> candidates;
  std::vector<std::size_t> row(factors, 0);
  for (bool more = true; more;) {
    if (!allowed || allowed(row)) candidates.push_back(row);
    more = false;
    for (std::size_t f = factors; f-- > 0 && !more;) {
      row[f] = row[f] + 1 < levels[f] ? row[f] + 1 : 0;
      more = row[f] != 0;
    }
  }
  std::set<std::array<std::size_t, 4>> left; // two factors and their levels
  const auto for_pairs = [&](const std::vector<std::size_t>& of, const auto& visit) {
    for (std::size_t a = 0; a < factors; ++a)
      for (std::size_t b = a + 1; b < factors; ++b) visit(std::array{a, b, of[a], of[b]});
  };
  for (const auto& candidate : candidates) for_pairs(candidate, [&](const auto& pair) { left.insert(pair); });
  std::vector<std::vector<std::size_t>> rows;
  while (!left.empty()) {
    std::size_t most = 0;
    const std::vector<std::size_t>* best = nullptr;
    for (const auto& candidate : candidates) {
      std::size_t fresh = 0;
      for_pairs(candidate, [&](const auto& pair) { fresh += left.count(pair); });
      if (fresh <= most) continue;
      most = fresh;
      best = &candidate;
    }
    for_pairs(*best, [&](const auto& pair) { left.erase(pair); });
    rows.push_back(*best);
  }
  return rows;
}

const std::vector<Choice>& pairwise_choices() {
  static const std::vector<Choice> choices = [] {
    const auto allowed = [](const std::vector<std::size_t>& row) {
      return friction_laws[row[0]].value != FrictionLaw::spring || precisions[row[1]].value != Precision::mixed;
    };
    std::vector<Choice> all;
    for (const std::vector<std::size_t>& row :
         pairwise_rows({friction_laws.size(), precisions.size(), policies.size(), steps_per_contact.size(),
                        integrators.size(), seeds.size()},
                       allowed))
      all.push_back({friction_laws[row[0]].value, precisions[row[1]].value, policies[row[2]].value,
                     steps_per_contact[row[3]], integrators[row[4]].value, seeds[row[5]]});
    return all;
  }();
  return choices;
}

void apply(const Choice& choice, Scene& scene) {
  scene.contact.friction = choice.friction;
  std::vector<ContactConstants*> all{&scene.contact.granule};
  if (scene.contact.wall) all.push_back(&*scene.contact.wall);
  for (PairContact& pair : scene.contact.pairs) all.push_back(&pair.constants);
  for (ContactConstants* constants : all) {
    if (choice.friction == FrictionLaw::none) constants->friction.reset();
    if (choice.friction != FrictionLaw::spring) continue;
    constants->tangential_stiffness = 0.8 * constants->stiffness.value();
    constants->tangential_damping = 0.01;
  }
  scene.verlet.policy = choice.policy;
  scene.time.steps_per_contact = choice.steps_per_contact;
  scene.time.precision = choice.precision;
  scene.time.integrator = choice.integrator;
  scene.seed = choice.seed;
}

} // namespace grandamp::test
