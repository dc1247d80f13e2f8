// What choices move: one scale per scene, gains told apart, levels told by their values.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "runners/answers/limits.hpp"
#include "tests/runners/answers/small_studies.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using synthetic::full_factorial, synthetic::sentences;

namespace {

const std::vector<double> steps = {4e-4, 2e-4, 1e-4};

std::vector<std::string> levels(const std::string& name, int count) {
  std::vector<std::string> out;
  for (int k = 0; k < count; ++k) out.push_back(name + static_cast<char>('a' + k));
  return out;
}

}  // namespace

TEST_CASE("differences are shares of one scale per scene, not of each combination's own largest value") {
  // In every scene the hard law leaves 1e-3 of what the soft one leaves; schemes differ by as little on the hard one.
  const StudyResults results = full_factorial(
      {{"stops.lower", levels("s", 4)}, {"contact", {"hard", "soft"}}, {"time", {"one", "other"}}}, steps,
      [](const auto& at, double) { return (1 + at[0]) * (at[1]   ? 1.0
                                                         : at[2] ? 1e-3
                                                                 : 2e-3); }, "impulse");
  const std::string text = sentences(results);
  INFO(text);
  CHECK_THAT(text, Contains("What moves impulse most is the contact law"));
  CHECK_THAT(text, Contains("the time scheme (0.05 %"));
  CHECK_THAT(text, !Contains("the time scheme (up to"));
}

TEST_CASE("what gains energy is told by name, and no choice moves the energy by it") {
  StudyResults results = full_factorial(
      {{"stops.lower", levels("s", 4)}, {"contact", {"hard", "soft"}}, {"time", {"one", "other"}}}, steps,
      [](const auto& at, double step) { return at[1] && at[2] ? 0.1 / step : 0.5 + 0.1 * at[1] + step; });
  const std::string text = sentences(results);
  INFO(text);
  CHECK_THAT(text, Contains("Other with soft gains energy: 1000 times the start at h = 1e-4 s") ||
                       Contains("Soft with other gains energy: 1000 times the start at h = 1e-4 s"));
  CHECK_THAT(text, Contains("and finer steps do not cure it"));
  CHECK_THAT(text,
             Contains("What moves the energy left most is the contact law: 50.01 % with hard, 60.01 % with soft"));
}

TEST_CASE("levels that are apart whatever else is chosen are told by their values, others by what they move") {
  const auto study = [&](double spread) {
    return sentences(full_factorial(
        {{"stops.lower", levels("s", 4)}, {"contact", {"hard", "soft"}}}, steps,
        [=](const auto& at, double) { return 1 + at[1] + spread * at[0]; }, "impulse"));
  };
  CHECK_THAT(study(0.02), Contains("the contact law: 1.00 to 1.06 N s with hard, 2.00 to 2.06 N s with soft"));
  CHECK_THAT(study(0.3), Contains("the contact law: by ") && !Contains("with hard, "));
}

TEST_CASE("at one step and mesh the first sentence says that refinement is not known") {
  const std::string text = sentences(full_factorial({{"stops.lower", levels("s", 4)}, {"contact", {"hard", "soft"}}},
                                                    {1e-4}, [](const auto& at, double) { return 0.4 + 0.1 * at[1]; }));
  CHECK_THAT(text.substr(0, text.find('\n')), Contains("at one step and one mesh, what refinement leaves"));
}

TEST_CASE("many levels of a compared choice of which none agrees with the first are told in tiers of their values") {
  const double left[] = {0.1, 0.9, 0.905, 0.6, 0.6, 0.3};
  StudyResults results = full_factorial(
      {{"contact", levels("l", 6)}, {"time", {"one", "other"}}}, steps,
      [&](const auto& at, double) { return at[0] == 0 ? 0.1 + 0.5 * at[1] : left[at[0]] + 1e-4 * at[1]; });
  results.study["compare"] = "contact";
  const std::string text = sentences(results);
  INFO(text);
  CHECK_THAT(text, Contains("The energy left: 90.0 to 90.5 % with lb and lc; 60.00 to 60.01 % with ld and le; "
                            "30.00 to 30.01 % with lf."));
  CHECK_THAT(text, Contains("With la the energy left depends on the time scheme: 10 to 60 %."));
}

TEST_CASE("a paired difference is never wider than the sum of its two limits, nor the other way round") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < 100; ++draw) {
    const StudyResults results = full_factorial({{"mass", {"one", "other"}}}, {8e-4, 4e-4, 2e-4, 1e-4},
                                                [&](const auto&, double) { return 0.5 + 0.1 * normal(random); });
    const answers::Compared study(results);
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

TEST_CASE("another unit of a measure changes its numbers alone") {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform;
  for (int draw = 0; draw < 30; ++draw) {
    const double a = uniform(random), b = uniform(random);
    const auto forms = [&](double unit) {
      const Table answers = answers_table(answers::Compared(full_factorial(
          {{"mass", {"one", "other"}}, {"contact", {"hard", "soft"}}}, steps,
          [&](const auto& at, double step) { return unit * (1 + a * at[0] + b * at[1] * at[0] + 100 * step); },
          "impulse")));
      const TableReader rows(answers);
      std::string out;
      for (std::size_t row = 0; row < rows.size(); ++row)
        out += rows.text(row, "form") + " " + rows.text(row, "who") + " " + rows.text(row, "methods") + "\n";
      return out;
    };
    CHECK(forms(1) == forms(1024));
  }
}

TEST_CASE("of a compared number the end is told from which on it moves next to nothing") {
  const std::vector<std::string> stiffness = {"1000", "10000", "100000", "1e6", "1e7"};
  StudyResults results = full_factorial({{"contact.stiffness", stiffness}, {"time", {"one", "other"}}}, steps,
                                        [](const auto& at, double) { return 0.5 - 0.1 * std::pow(0.1, at[0]); });
  results.study["compare"] = "contact.stiffness";
  const std::string text = sentences(results);
  INFO(text);
  // 0.1, 0.01 and 0.001 below the limit; the tenth of one per cent is met from the third on.
  CHECK_THAT(text, Contains("From stiffness 1e5 on it moves the energy left by at most 0.099 %.") ||
                       Contains("From stiffness 100000 on it moves the energy left by at most 0.099 %."));
}

TEST_CASE("of two or three scenes each is answered by itself, with its own truth and its own gains") {
  StudyResults results = full_factorial(
      {{"structure.damping.stiffness", {"0", "0.001"}}, {"mass", {"one", "other"}}, {"time", {"a", "b"}}}, steps,
      [](const auto& at, double step) {
        if (at[0] == 1) return 0.4 + step;
        return at[1] == 0 ? 0.999 + step : at[2] == 0 ? 0.8 + step : 2 + step;
      });
  // Only the second scene is damped.
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "0.001") record.measures.back().second = 1;
  const std::string text = sentences(results);
  INFO(text);
  CHECK_THAT(text, Contains("With viscosity 0: the one mass keeps it: "));
  CHECK_THAT(text, Contains("With viscosity 0: the other mass with b gains energy: 2 times the start"));
  CHECK_THAT(text, Contains("With viscosity 0.001: no difference: the energy left is 40.01 % whichever method"));
}

TEST_CASE("a measure that agrees as well is told with its value, several with how far they are apart") {
  StudyResults results = full_factorial({{"mass", {"one", "other"}}}, steps,
                                        [](const auto& at, double step) { return 0.4 + 1e-4 * at[0] + step; });
  for (CaseRecord& record : results.cases) record.measures.emplace_back("impulse", 2);
  results.study["observe"] = {"energy_left", "impulse"};
  CHECK_THAT(sentences(results), Contains("Impulse agrees as well: 2 N s, nothing apart."));
}

TEST_CASE("a mass of the scene is never called by the name of a role") {
  CHECK(answers::spoken("mass") == "the mass matrix");
  CHECK(answers::spoken("structure.mass") == "the mass of the oscillator");
  CHECK(answers::spoken("structure.masses.0.mass") == "the point mass");
  CHECK(answers::spoken("structure.young") == "Young's modulus");
}
