// Where a motion without contact first touches a stop, along a parameter.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/stability/linear_response.hpp>

using namespace ricochet;

namespace grazing_tests {

namespace {

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(from + (to - from) * k / (count - 1));
  return out;
}

}  // namespace

TEST_CASE("grazing: each zero of the overlap is found to round-off, with the side without contact") {
  // Contact outside ]1, √5[: opens at 1 from below, closes at √5.
  const auto found =
      find_grazings(evenly(0, 4, 33), [](double a) { return std::optional((a - 1) * (a - std::sqrt(5.0))); });
  REQUIRE(found.size() == 2);
  CHECK(found[0].value == Approx(1).epsilon(1e-11));
  CHECK_FALSE(found[0].opens_below);
  CHECK(found[1].value == Approx(std::sqrt(5.0)).epsilon(1e-11));
  CHECK(found[1].opens_below);
  for (const Grazing& one : found) {
    CHECK(one.low <= one.value);
    CHECK(one.value <= one.high);
    CHECK(one.high - one.low <= 1e-11);
    CHECK(one.steps > 20);
  }
}

TEST_CASE("grazing: no change of sign, or nothing known on one side of it, is none") {
  CHECK(find_grazings({}, [](double) { return std::optional(1.0); }).empty());
  CHECK(find_grazings({2}, [](double) { return std::optional(1.0); }).empty());
  CHECK(find_grazings(evenly(0, 1, 9), [](double a) { return std::optional(a + 1); }).empty());
  const auto unknown = [](double a) { return a < 0.5 ? std::nullopt : std::optional(a - 0.4); };
  CHECK(find_grazings(evenly(0, 1, 9), unknown).empty());
  // A gap in what is known ends the search where it meets it; what is bracketed by then is told.
  const auto holed = [](double a) { return std::abs(a - 0.55) < 0.01 ? std::nullopt : std::optional(a - 0.54); };
  const auto found = find_grazings(evenly(0, 1, 2), holed);
  REQUIRE(found.size() == 1);
  CHECK(found[0].low <= 0.54);
  CHECK(found[0].high >= 0.54);
}

}  // namespace grazing_tests
