// Where bodies are drawn: what meets stands across, what would overlap does not.
#include "runners/study/body_places.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("a body stands across from what it meets, above what goes upwards to it") {
  const std::vector<BodyShape> bodies = {{0, 0.5, false}, {0, 0.04, false}};
  const auto above = body_places(bodies, {{0, 1, 0.25, 0.02, true}});
  CHECK(above[0].row == 0);
  CHECK(above[1].row == 1);
  CHECK(above[1].shift + 0.02 == Approx(above[0].shift + 0.25));
  const auto below = body_places(bodies, {{0, 1, 0.25, 0.02, false}});
  CHECK(below[1].row == 0);
  CHECK(below[0].row == 1);
}

TEST_CASE("parallel bodies that meet one partner from one side take rows of their own") {
  const std::vector<BodyShape> rods = {{0, 1, false}, {0, 1, false}, {0, 1, false}, {0, 1, false}};
  // Two below the second, and one that meets none.
  const auto places = body_places(rods, {{0, 1, 0.3, 0.3, true}, {2, 1, 0.7, 0.7, true}});
  std::vector<int> rows;
  for (const BodyPlace& one : places) {
    rows.push_back(one.row);
    CHECK(one.shift == 0);
  }
  CHECK(rows == std::vector<int>{1, 2, 0, 3});
}

TEST_CASE("short bodies along a long one share a row") {
  const std::vector<BodyShape> bodies = {{0, 1, false}, {0, 0.1, false}, {0, 0.1, false}};
  const auto places = body_places(bodies, {{0, 1, 0.2, 0.05, true}, {0, 2, 0.8, 0.05, true}});
  CHECK(places[1].row == 1);
  CHECK(places[2].row == 1);
  CHECK(places[2].shift == Approx(0.75));
}

TEST_CASE("what moves along its axis stands in a chain, one in each row") {
  const std::vector<BodyShape> masses = {{0, 0, true}, {0, 0, true}, {0, 0, true}};
  CHECK(all_along(masses));
  const auto places = body_places(masses, {{0, 1, 0, 0, true}, {2, 1, 0, 0, false}});
  CHECK(places[0].row == 0);
  CHECK(places[1].row == 1);
  CHECK(places[2].row == 2);
}
