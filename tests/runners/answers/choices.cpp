// Differences of methods, and what sentences call choices.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "runners/answers/limits.hpp"
#include "tests/runners/answers/small_studies.hpp"

using namespace ricochet;
using synthetic::full_factorial;

TEST_CASE("a paired difference is never wider than the sum of its two limits, nor the other way round") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < 100; ++draw) {
    const StudyResults results = full_factorial({{"mass", {"one", "other"}}}, {8e-4, 4e-4, 2e-4, 1e-4},
                                                [&](const auto&, double) { return 0.5 + 0.1 * normal(random); });
    const Choices study(results);
    const answers::MeasureLimits limits = answers::limits_of(study, "energy_left", true, all_cases(results));
    const auto methods = limits.with_limit();
    REQUIRE(methods.size() == 2);
    const answers::Difference there = answers::paired(*methods[0], *methods[1]),
                              back = answers::paired(*methods[1], *methods[0]);
    CHECK(*there.uncertainty <= *methods[0]->limit->uncertainty + *methods[1]->limit->uncertainty + 1e-15);
    CHECK(there.value == Approx(back.value));
    CHECK(*there.uncertainty == Approx(*back.uncertainty));
  }
}

TEST_CASE("a mass of the scene is never called by the name of a role") {
  CHECK(spoken("mass") == "the mass matrix");
  CHECK(spoken("structure.mass") == "the mass of the oscillator");
  CHECK(spoken("structure.masses.0.mass") == "the point mass");
  CHECK(spoken("structure.young") == "Young's modulus");
}
