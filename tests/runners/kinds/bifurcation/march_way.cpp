// Orbits that leave out steps are those that march them all: same classes, sections and impacts, whatever the threads.
#include "tests/runners/kinds/sweep/sweep_case.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("bifurcation: orbits that leave out steps land where those that march them do") {
  Json text = beam_sweep({0.05, 0.085, 0.0875}, Json::array({"rest", "up"}));
  text["steps_per_period"] = 2000;
  text["scene"]["stops"]["at"] = GENERATE("tip", "nodes");
  const CaseRecord every = run_sweep(text);
  text["march"] = "flights";
  const CaseRecord flown = run_sweep(text);
  REQUIRE(every.status == Status::done);
  REQUIRE(flown.status == Status::done);
  CHECK(flown.operator_name == "modal");
  for (const char* column : {"tip_displacement", "tip_velocity", "opposite_displacement"}) {
    const std::vector<double>&a = column_of(numbers_of(every, "points"), column),
          &b = column_of(numbers_of(flown, "points"), column);
    INFO(column);
    REQUIRE(a.size() == b.size());
    double size = 0, apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      size = std::max(size, std::abs(a[i]));
      apart = std::max(apart, std::abs(a[i] - b[i]));
    }
    // Orbits that settle forget how they came there.
    CHECK(apart < 1e-6 * size);
  }
  const std::vector<double>&a = column_of(numbers_of(every, "impacts"), "speed"),
        &b = column_of(numbers_of(flown, "impacts"), "speed");
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).epsilon(1e-5).margin(1e-7));
  CHECK((bits_of(run_sweep(text, 3)) == bits_of(flown)));
}

TEST_CASE("bifurcation: extrema of the tip are found in steps that are left out") {
  Json text = beam_sweep({0.05, 0.085}, Json::array({"rest"}));
  text["steps_per_period"] = 2000;
  text["section"] = "extremum";
  // At a rigid stop the tip would rest, and turn at every step by round-off.
  text["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e4}};
  const CaseRecord every = run_sweep(text);
  text["march"] = "flights";
  const CaseRecord flown = run_sweep(text);
  REQUIRE(flown.status == Status::done);
  CHECK(flown.operator_name == "modal");
  for (const char* column : {"tip_displacement", "tip_velocity"}) {
    const std::vector<double>&a = column_of(numbers_of(every, "points"), column),
          &b = column_of(numbers_of(flown, "points"), column);
    INFO(column);
    REQUIRE(a.size() > 4);
    REQUIRE(a.size() == b.size());
    double size = 0, apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      size = std::max(size, std::abs(a[i]));
      apart = std::max(apart, std::abs(a[i] - b[i]));
    }
    CHECK(apart < 1e-6 * size);
  }
}

TEST_CASE("bifurcation: exponents of orbits that leave out steps are marched at every step") {
  Json text = beam_sweep({0.085});
  text["steps_per_period"] = 500;
  text["exponents"] = 1;
  const CaseRecord every = run_sweep(text);
  text["march"] = "flights";
  const CaseRecord flown = run_sweep(text);
  // Where it begins differs by round-off, and what is asked of it by what its own interval leaves open.
  CHECK(of_values(flown, "exponent_1")[0].number().value() ==
        Approx(of_values(every, "exponent_1")[0].number().value()).epsilon(1e-3));
  CHECK(of_values(flown, "exponent_method")[0] == of_values(every, "exponent_method")[0]);
}
