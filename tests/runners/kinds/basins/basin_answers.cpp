// What a study of basins answers: where starts end, which choice moves the border, what is undecided.
#include <catch2/catch.hpp>

#include "runners/kinds/basins/basin_analysis.hpp"
#include "runners/kinds/basins/basins.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

struct BasinCase {
  std::string mass;
  int steps = 0;
  std::vector<double> fractions;  ///< of attractors 1, 2, …
  int undecided = 0;              ///< of 100 cells
};

/// Cases with what becomes of 100 starts each.
struct Basins {
  StudyResults results;
  BasinAnalysis analysis;
};

/// `differ` gives the cells in which two of them differ.
Basins basins_of(const std::vector<BasinCase>& cases, const std::vector<std::array<int, 3>>& differ) {
  Basins out;
  out.results.kind = "basins";
  out.results.columns = {"mass", "steps_per_period"};
  for (std::size_t c = 0; c < cases.size(); ++c) {
    CaseRecord& record = out.results.cases.emplace_back();
    record.id = "c" + std::to_string(c);
    record.status = "done";
    record.axes = {{"mass", cases[c].mass}, {"steps_per_period", cases[c].steps}};
    for (std::size_t k = 0; k < cases[c].fractions.size(); ++k) {
      const double share = cases[c].fractions[k];
      const int number = static_cast<int>(k) + 1;
      out.analysis.fractions.push_back(
          {record.id, number, "periodic", number, static_cast<int>(100 * share), share, share - 0.02, share + 0.02});
    }
    const auto undecided = static_cast<std::size_t>(cases[c].undecided);
    out.analysis.starts[record.id] = {100, 0, 100 - undecided, undecided};
  }
  for (const auto& [one, other, count] : differ)
    out.analysis.differences.push_back(
        {"c" + std::to_string(one), "c" + std::to_string(other), 100, count, 0.01 * count});
  return out;
}

std::string basins_said(const Basins& basins) {
  std::string out;
  for (const answers::Sentence& one : basins_answer(answers::Compared(basins.results), basins.analysis).sentences)
    out += one.text + "\n";
  return out;
}

}  // namespace

TEST_CASE("cases that lead as many starts to every end are told together, others by name") {
  const std::string alike =
      basins_said(basins_of({{"full", 200, {0.8, 0.2}}, {"lumped", 200, {0.81, 0.19}}}, {{0, 1, 0}}));
  INFO(alike);
  CHECK_THAT(alike, Catch::Matchers::StartsWith("80") && Contains("% of the starts end in period 1"));
  CHECK_THAT(alike, Contains("The mass matrix does not move the border: 0 of 100 cells differ."));
  const std::string apart =
      basins_said(basins_of({{"full", 200, {0.8, 0.2}}, {"lumped", 200, {0.3, 0.7}}}, {{0, 1, 50}}));
  INFO(apart);
  CHECK_THAT(apart, Contains("With full 80") && Contains("With lumped 70"));
  CHECK_THAT(apart, Contains("The mass matrix moves the border: 50 of 100 cells differ between full and lumped."));
}

TEST_CASE("the choice that moves the border is that in which alone two cases differ") {
  const std::vector<BasinCase> cases = {
      {"full", 200, {0.8, 0.2}}, {"full", 800, {0.8, 0.2}}, {"lumped", 200, {0.8, 0.2}}, {"lumped", 800, {0.8, 0.2}}};
  const std::string text =
      basins_said(basins_of(cases, {{0, 1, 9}, {2, 3, 8}, {0, 2, 0}, {1, 3, 0}, {0, 3, 9}, {1, 2, 9}}));
  INFO(text);
  CHECK_THAT(text,
             Contains("The number of steps per period moves the border: 9 of 100 cells differ between full, 200"));
  CHECK_THAT(text, Contains("The mass matrix does not move the border: 0 of 100 cells differ."));
}

TEST_CASE("of cases with most starts undecided no end is told") {
  const std::string text =
      basins_said(basins_of({{"full", 200, {0.8, 0.2}, 10}, {"lumped", 200, {1, 0}, 99}}, {{0, 1, 1}}));
  INFO(text);
  CHECK_THAT(text, Catch::Matchers::StartsWith("10 % to 99 % of the starts are undecided"));
  CHECK_THAT(text, Contains("With full 80") && !Contains("With lumped"));
  CHECK_THAT(text, !Contains("the border:"));
}
