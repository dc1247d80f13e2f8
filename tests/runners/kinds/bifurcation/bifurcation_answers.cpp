// What a study of diagrams answers: which motions are met, who agrees on them, from which step on.
#include "runners/kinds/bifurcation/bifurcation_answers.hpp"

#include <catch2/catch.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/synthetic_dynamics.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

std::string said(const StudyResults& results, const std::string& verdict) {
  Table answers = answers_head();
  say_diagram(results, answers);
  const TableReader rows(answers);
  std::string out;
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows.text(row, "verdict") == verdict) out += rows.text(row, "sentence") + "\n";
  return out;
}

// Cases of two methods at some steps each; the last of the first method is what all are compared with.
StudyResults agreements(const std::vector<double>& steps, const std::map<std::string, std::vector<double>>& shares) {
  StudyResults results;
  results.kind = "bifurcation";
  results.columns = {"time", "steps_per_period"};
  Table agreement{"agreement", "", named_columns({"case", "other_case", "compared", "same_class"}), {}};
  Table distances{"distances", "", named_columns({"reference_case"}), {}};
  const std::string standard = "a" + std::to_string(steps.size() - 1);
  for (const auto& [method, found] : shares)
    for (std::size_t k = 0; k < steps.size(); ++k) {
      CaseRecord record;
      record.id = method + std::to_string(k);
      record.status = "done";
      record.axes = {{"time", method}, {"steps_per_period", steps[k]}};
      results.cases.push_back(std::move(record));
      // What is left open by one case is not compared.
      agreement.rows.push_back(
          {standard, method + std::to_string(k), method == "c" ? 100 * found[k] : 100, 100 * found[k]});
    }
  distances.rows.push_back({standard});
  results.derived = {std::move(distances), std::move(agreement)};
  return results;
}

}  // namespace

TEST_CASE("an answer follows the motion of the finest case along the parameter, and counts it where it changes often") {
  synthetic::DynamicsShape shape;
  shape.values = 4;
  shape.starts = {"rest"};
  StudyResults results = synthetic::dynamics(shape);
  Table& values = results.cases.front().tables.front();
  const TableReader rows(values);
  const std::size_t regime = rows.column("class"), period = rows.column("period"), status = rows.column("status");
  const std::pair<const char*, Cell> motions[] = {{"no contact", 1}, {"periodic", 2}, {"periodic", 2}, {"chaotic", {}}};
  for (std::size_t row = 0; row < 4; ++row) {
    values.rows[row][regime] = motions[row].first;
    values.rows[row][period] = motions[row].second;
    values.rows[row][status] = "done";
  }
  CHECK_THAT(said(results, "diagram"), Contains("From rest, in the reference case") &&
                                           Contains("no contact at 0.07, periodic 2 from 0.08 to 0.09") &&
                                           Contains("chaotic at 0.1"));
  shape.values = 120;
  shape.refused = false;
  results = synthetic::dynamics(shape);
  Table& many = results.cases.front().tables.front();
  for (std::size_t row = 0; row < many.rows.size(); ++row) {
    many.rows[row][regime] = row % 3 == 0 ? "chaotic" : "periodic";
    many.rows[row][period] = row % 3 == 0 ? Cell() : Cell(3);
  }
  CHECK_THAT(said(results, "diagram"), Contains("periodic 3 at 80 of 120 values, chaotic at 40"));
}

TEST_CASE("motions of one impact are told with its speed, and how far others are from it") {
  synthetic::DynamicsShape shape;
  shape.values = 4;
  shape.starts = {"rest"};
  StudyResults results = synthetic::dynamics(shape);
  for (CaseRecord& record : results.cases) record.numbers.clear();
  CHECK(said(results, "impacts").empty());
  // Twice within a period is no one speed.
  for (CaseRecord& record : results.cases) {
    NumberTable table = number_table("impacts", named_columns({"parameter", "start", "speed"}));
    table.words = {{"start", {"rest"}}};
    table.add({0.08, 0, &record == &results.cases.front() ? 2 : 2.1});
    for (const double speed : {3, 4}) table.add({0.09, 0, speed});
    record.numbers = {table};
  }
  CHECK_THAT(said(results, "impacts"),
             Contains("hits the stop with 2 m/s at 0.08; in other cases with up to 5 % more"));
}

TEST_CASE("few cases are told one by one, many by the step from which on they agree") {
  const StudyResults few = agreements({500, 2000}, {{"a", {0.7, 1}}, {"b", {0.5, 0.9}}});
  CHECK_THAT(
      said(few, "agreement"),
      Contains("Of 100 classes of motion that a, 2000 steps per period has over values and starts, others share: "
               "90 (b, 2000 steps per period), 70 (a, 500 steps per period), 50 (b, 500 steps per period)."));
  const StudyResults many =
      agreements({500, 1000, 2000, 4000},
                 {{"a", {0.7, 0.96, 0.96, 1}}, {"b", {0.96, 0.5, 0.97, 0.98}}, {"c", {0.1, 0.2, 0.3, 0.4}}});
  const std::string text = said(many, "agreement");
  CHECK_THAT(text, Contains("from 1000 steps per period on: a."));
  // What agrees at a coarse step and not at a finer one agreed by chance.
  CHECK_THAT(text, Contains("from 2000 steps per period on: b."));
  CHECK_THAT(text,
             Contains("Fewer of the 100 classes of a, 4000 steps per period at every step") && Contains(": 40 (c)."));
}

TEST_CASE("attractors are counted by who shows them, of a single case there is nothing to compare") {
  CHECK_THAT(said(synthetic::dynamics(), "attractors"), Contains("2 attractors were met over all values") &&
                                                            Contains("common to all (1), depends on time.beta (1)"));
  StudyResults alone = agreements({500}, {{"a", {1}}});
  alone.derived.clear();
  CHECK(said(alone, "agreement").empty());
  CHECK(said(alone, "attractors").empty());
}
