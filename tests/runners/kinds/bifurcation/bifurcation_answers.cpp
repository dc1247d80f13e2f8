// What a study of diagrams answers: who has the reference's diagram, how it converges, which motions there are.
#include <catch2/catch.hpp>

#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "tests/runners/report/synthetic_dynamics.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

std::string said(const StudyResults& results) {
  std::string out;
  const answers::Compared study(results);
  for (const answers::Sentence& one : bifurcation_answer(study).sentences) out += one.text + "\n";
  return out;
}

/// Cases of methods at some steps each; the last of the first method is what all are compared with.
StudyResults agreements(const std::vector<double>& steps, const std::map<std::string, std::vector<double>>& shares,
                        const std::map<std::string, std::vector<double>>& apart) {
  StudyResults results;
  results.kind = "bifurcation";
  results.columns = {"time", "steps_per_period"};
  Table agreement{"agreement", "", named_columns({"case", "other_case", "compared", "same_class"}), {}};
  Table distances{"distances", "", named_columns({"case", "reference_case", "wasserstein"}), {}};
  const std::string standard = "a" + std::to_string(steps.size() - 1);
  for (const auto& [method, found] : shares)
    for (std::size_t k = 0; k < steps.size(); ++k) {
      CaseRecord record;
      record.id = method + std::to_string(k);
      record.status = "done";
      record.axes = {{"time", method}, {"steps_per_period", steps[k]}};
      agreement.rows.push_back({standard, record.id, 100, 100 * found[k]});
      if (record.id != standard) distances.rows.push_back({record.id, standard, apart.at(method)[k]});
      results.cases.push_back(std::move(record));
    }
  results.derived = {std::move(distances), std::move(agreement)};
  return results;
}

}  // namespace

TEST_CASE("the same diagram is at least nine tenths of all motions, or near with none contradicted") {
  const std::string text = said(agreements({500, 2000}, {{"a", {0.7, 1}}, {"b", {0.5, 0.9}}, {"c", {0.5, 0.6}}},
                                           {{"a", {0.2, 0}}, {"b", {0.3, 0.002}}, {"c", {0.3, 0.2}}}));
  CHECK_THAT(text,
             Contains("The diagram of a at 2000 steps per period is also that of b (90 of 100 motions, 0.002 away)."));
  CHECK_THAT(text, Contains("Another: c (60 of 100 motions, 0.2 away)."));
  CHECK_THAT(text, Contains("whether it converges needs a third number of steps"));
}

TEST_CASE("a diagram that is near with a quarter contradicted at most is nearly the same") {
  const std::string text = said(agreements({500, 2000}, {{"a", {0.7, 1}}, {"b", {0.5, 0.8}}, {"c", {0.5, 0.7}}},
                                           {{"a", {0.2, 0}}, {"b", {0.3, 0.004}}, {"c", {0.3, 0.004}}}));
  CHECK_THAT(text, Contains("The diagram of a at 2000 steps per period is nearly that of b (80 of 100 motions"));
  CHECK_THAT(text, Contains("Another: c (70 of 100 motions"));
}

TEST_CASE("motions that coexist are told with their values") {
  StudyResults results = agreements({2000}, {{"a", {1}}, {"b", {0.9}}}, {{"a", {0}}, {"b", {0.002}}});
  Table values{"values", "", named_columns({"case", "parameter", "start", "class", "period", "attractor"}), {}};
  for (const char* id : {"a0", "b0"})
    for (const double value : {1.0, 2.0, 3.0}) {
      values.rows.push_back({id, value, "random-1", "periodic", 1, 1});
      if (value < 3) values.rows.push_back({id, value, "random-2", "periodic", 2, 2});
    }
  results.derived.push_back(values);
  CHECK_THAT(said(results), Contains("Motions coexist: period 1 and period 2 from 1 to 2") &&
                                Contains("several in every case at all of these values"));
}

TEST_CASE("from three numbers of steps on the distance has an order") {
  const std::string text = said(agreements({500, 1000, 2000}, {{"a", {0.7, 0.9, 1}}}, {{"a", {0.16, 0.04, 0}}}));
  CHECK_THAT(text, Contains("the distance falls with order 2.0"));
}

TEST_CASE("motions of one impact are told with its speed, and how far others are from it") {
  synthetic::DynamicsShape shape;
  shape.values = 4;
  shape.starts = {"rest"};
  StudyResults results = synthetic::dynamics(shape);
  for (CaseRecord& record : results.cases) record.numbers.clear();
  CHECK(said(results).find("one impact") == std::string::npos);
  // Twice within a period is no one speed.
  for (CaseRecord& record : results.cases) {
    NumberTable table = number_table("impacts", named_columns({"parameter", "start", "speed"}));
    table.words = {{"start", {"rest"}}};
    table.add({0.08, 0, &record == &results.cases.front() ? 2 : 2.1});
    for (const double speed : {3, 4}) table.add({0.09, 0, speed});
    record.numbers = {table};
  }
  CHECK_THAT(said(results), Contains("Orbits with one impact hit with 2") && Contains("other cases within"));
}
