// The choices that every hard case is put to, and a table of them in which each pair of settings stands in some row.
#pragma once

#include "solver/scene.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace grandamp::test {

struct Choice {
  FrictionLaw friction = FrictionLaw::coulomb;
  Precision precision = Precision::full;
  ListPolicy policy = ListPolicy::guarded;
  double steps_per_contact = 8.0;
  Integrator integrator = Integrator::leapfrog;
  std::uint64_t seed = 1;
};

/// "coulomb, double, guarded, 8, leapfrog, 1": the settings in the order of Choice.
std::string told(const Choice& choice);

/// Whether the list may miss contacts, by its own rule.
inline bool may_miss(ListPolicy policy) {
  return policy == ListPolicy::predicted || policy == ListPolicy::fixed;
}

/// Rows of indices such that every pair of levels of any two factors that an allowed row can hold stands in one of
/// them: the greedy table, the same on every machine. `levels`: how many each factor has.
std::vector<std::vector<std::size_t>>
pairwise_rows(const std::vector<std::size_t>& levels,
              const std::function<bool(const std::vector<std::size_t>&)>& allowed = nullptr);

/// All pairs of settings but springs in mixed precision, which there are not. The first row has the program's defaults.
const std::vector<Choice>& pairwise_choices();

/// Gives the scene a choice. Springs get 0.8 of the normal stiffness and a little damping.
void apply(const Choice& choice, Scene& scene);

} // namespace grandamp::test
