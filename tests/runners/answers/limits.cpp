// The limits of methods along their refinements.
#include "runners/answers/limits.hpp"

#include <catch2/catch.hpp>
#include <ricochet/measure/statistics/draws.hpp>
#include <vector>

#include "runners/answers/uncertainty.hpp"
#include "runners/store/study_tables.hpp"
#include "tests/runners/answers/small_studies.hpp"

using namespace ricochet;
using namespace ricochet::answers;

TEST_CASE("limits: seeds are draws of one method, whose mean it has") {
  // The masses differ by 0.1, the draws by far more.
  const std::vector<double> draws = {1, 4, 2}, masses = {0, 0.1};
  StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0", "m1"}}, {"seed", {"1", "2", "3"}}}, {4e-3, 2e-3, 1e-3},
      [&](const std::vector<std::size_t>& at, double h) { return masses[at[0]] + draws[at[1]] + 10 * h; },
      "impulse[a]");
  const Choices study(results);
  const MeasureLimits limits = limits_of(study, "impulse[a]", false, all_cases(results));
  REQUIRE(limits.with_limit().size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const Method& one = *limits.with_limit()[k];
    CHECK(one.limit->value == Approx(masses[k] + 7.0 / 3 + 0.01));
    CHECK(one.step->uncertainty.value() < 0.02);
    CHECK(one.half == Approx(*half_interval(draws)));
  }
  for (const ChoiceEffect& effect : choice_effects(study, limits)) CHECK(effect.choice == "mass");
  const Table ranges = uncertainty_table(study);
  REQUIRE(ranges.rows.size() == 1);
  const auto cell = [&](const std::string& name) {
    for (std::size_t k = 0; k < ranges.columns.size(); ++k)
      if (ranges.columns[k].name == name) return ranges.rows.front()[k];
    return Cell();
  };
  CHECK(cell("methods").text() == "2");
  CHECK(number_in(cell("largest").text()).value() - number_in(cell("least").text()).value() == Approx(0.1));
  CHECK(cell("verdict").text() == "sampling");
}
