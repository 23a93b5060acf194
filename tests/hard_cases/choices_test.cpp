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
  // Rows that are not allowed are in no table, and take no other pair with them.
  std::size_t held = 0;
  for (const auto& row : pairwise_rows({2, 3, 3}, [](const auto& r) { return r[0] != 1 || r[1] != 2; })) {
    CHECK((row[0] != 1 || row[1] != 2));
    held += row[0] == 1 && row[2] == 2 ? 1 : 0;
  }
  CHECK(held > 0);

  const Choice first = pairwise_choices().front();
  CHECK(first.friction == FrictionLaw::coulomb);
  CHECK(first.policy == ListPolicy::guarded);
  CHECK(first.steps_per_contact == 8.0);
  CHECK(first.integrator == Integrator::leapfrog);
}
