// Lists that copies share: what one copy is written, another never shows.
#include "solver/shared_list.hpp"

#include <doctest/doctest.h>

#include <type_traits>
#include <utility>
#include <vector>

using namespace grandamp;

TEST_CASE("shared lists: copies share until one changes, and each keeps its own values") {
  const SharedList<double> first{1.0, 2.0, 3.0};
  SharedList<double> second = first;
  CHECK(std::as_const(second).data() == first.data());
  SUBCASE("by index") {
    second[1] = 5.0;
  }
  SUBCASE("by iterator") {
    *(second.begin() + 1) = 5.0;
  }
  SUBCASE("by assignment") {
    second = {1.0, 5.0, 3.0};
  }
  SUBCASE("by erasing and pushing") {
    second.erase(second.begin() + 1, second.end());
    second.push_back(5.0);
    second.push_back(3.0);
  }
  CHECK(second == std::vector<double>{1.0, 5.0, 3.0});
  CHECK(first == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(std::as_const(second).data() != first.data());
}

TEST_CASE("shared lists: what was handed out for writing writes into no copy made since") {
  SharedList<double> list{1.0, 2.0};
  double& lent = list[0];
  const auto place = list.begin();
  const SharedList<double> copy = list;
  SharedList<double> assigned;
  assigned = list;
  lent = 9.0;
  list.erase(place + 1);
  CHECK(list == std::vector<double>{9.0});
  CHECK(copy == std::vector<double>{1.0, 2.0});
  CHECK(assigned == std::vector<double>{1.0, 2.0});
}

TEST_CASE("shared lists: empty ones and moved ones, of a temporary no vector is to be had") {
  SharedList<double> none;
  CHECK(none.empty());
  CHECK(std::as_const(none).begin() == std::as_const(none).end());
  CHECK(none == std::vector<double>{});
  none.push_back(4.0);
  SharedList<double> moved = std::move(none);
  CHECK(moved == std::vector<double>{4.0});
  moved.clear();
  CHECK(moved.size() == 0);
  static_assert(std::is_convertible_v<SharedList<double>&, const std::vector<double>&>);
  static_assert(!std::is_convertible_v<SharedList<double>, const std::vector<double>&>);
}
