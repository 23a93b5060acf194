// The table of choices itself.
#include "tests/hard_cases/choices.hpp"

#include <doctest/doctest.h>

#include <set>
#include <tuple>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE("hard cases: every pair of settings stands in a row, and rows are few") {
  const std::vector<std::size_t> levels{3, 2, 6, 2, 2, 3};
  std::set<std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>> pairs;
  const auto rows = pairwise_rows(levels);
  for (const auto& row : rows)
    for (std::size_t a = 0; a < levels.size(); ++a)
      for (std::size_t b = a + 1; b < levels.size(); ++b) pairs.insert({a, b, row[a], row[b]});
  std::size_t all = 0;
  for (std::size_t a = 0; a < levels.size(); ++a)
    for (std::size_t b = a + 1; b < levels.size(); ++b) all += levels[a] * levels[b];
  CHECK(pairs.size() == all);
  CHECK(rows.size() <= 24);

  const Choice first = pairwise_choices().front();
  CHECK(first.friction == FrictionLaw::coulomb);
  CHECK(first.policy == ListPolicy::guarded);
  CHECK(first.steps_per_contact == 8.0);
  CHECK(first.integrator == Integrator::leapfrog);
}
