#include <catch2/catch.hpp>
#include <cmath>

#include "runners/kinds/trajectory/page/page.hpp"
#include "runners/report/report.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;

namespace {

/// The words for a trend of these ratios.
std::string words(const std::vector<double>& steps, const std::vector<double>& ratios) {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"step"};
  for (size_t k = 0; k < steps.size(); ++k) {
    CaseRecord record;
    record.id = std::to_string(k);
    record.axes = {{"step", steps[k]}};
    record.status = "done";
    record.steps = 4000;  // a noise floor of 9e-13
    record.measures = {{"energy_left", ratios[k]}, {"work_of_damping", 0}, {"work_of_loads", 0}};
    results.cases.push_back(record);
  }
  const Table trends = energy_trends_table(results);
  REQUIRE(trends.rows.size() == 1);
  return trend_sentence(TableReader(trends), 0);
}

bool starts(const std::string& text, const char* with) {
  return text.rfind(with, 0) == 0;
}

/// The answer to what the cases have measured by now.
std::string answer_of(StudyResults results) {
  synthetic::derive_energies(results);
  return answer_html(CaseView(results), trajectory_page());
}

}  // namespace

TEST_CASE("a trend is told from the measured ratios", "[report]") {
  const std::vector<double> steps = {1e-4, 1e-5, 1e-6};
  CHECK(starts(words(steps, {1, 1 + 1e-13, 1 - 1e-13}), "kept to the noise floor at every step"));
  CHECK(starts(words(steps, {0.9, 0.99, 0.999}), "comes closer"));
  CHECK(starts(words(steps, {0.9, 0.8, 0.6}), "loses more"));
  CHECK(starts(words(steps, {1.5, 2.5, 9}), "gains more"));
  CHECK(starts(words(steps, {0.8, 0.71, 0.7099}), "settles near 70.99 %"));
  CHECK(starts(words(steps, {0.721, 0.723, 0.722}), "the same change at every step"));
  CHECK(starts(words(steps, {0.9, 0.7, 0.95}), "no steady trend"));
  CHECK(starts(words(steps, {0.9, 0.99, 1}), "reaches its start"));
  CHECK(starts(words({1e-4}, {0.9}), "one step only"));
}

TEST_CASE("the answer's figures are those of the results", "[report]") {
  StudyResults results = synthetic::results();
  const std::string answer = answer_of(results);
  const auto says = [&](const std::string& text) { return answer.find(text) != std::string::npos; };
  double low = INFINITY, high = 0;
  for (const CaseRecord& record : results.cases)
    if (record.status == "done" && CaseView::text(record, "mass.velocity") == "P1") {
      low = std::min(low, *ricochet::measure(record, "energy_left"));
      high = std::max(high, *ricochet::measure(record, "energy_left"));
    }
  CHECK(low < high);
  CHECK(says("over 6 finished cases the energy ends at 99.60 % to 99.9960 % of what was brought in"));
  CHECK(says("closest to its start is <strong>singular, velocity P1"));
  CHECK(says("In 2 of 8 cases single steps gain energy, at most 5 %"));
  CHECK(says("1 diverged"));
  CHECK(says("3 refused"));
  CHECK(says("diverged at 1e-6"));

  SECTION("other measurements, other words") {
    for (CaseRecord& record : results.cases)
      for (auto& [name, value] : record.measures)
        if (name == "energy_left") value = CaseView::text(record, "mass") == "consistent" ? 1 : 0.5;
    const std::string changed = answer_of(results);
    CHECK(changed.find("closest to its start is <strong>consistent") != std::string::npos);
    CHECK(changed.find("8 of 28 finished cases over all steps end where they began") != std::string::npos);
  }
  SECTION("where damping works, the start is no reference") {
    for (CaseRecord& record : results.cases)
      for (auto& [name, value] : record.measures)
        if (name == "work_of_damping") value = -0.4;
    const std::string damped = answer_of(results);
    CHECK(damped.find("closest to its start") == std::string::npos);
    CHECK(damped.find("damping −0.4 to −0.4 J. What went") != std::string::npos);
    CHECK(damped.find("Contact took") != std::string::npos);
  }
  SECTION("where nothing is brought in there is no ratio, and none is made up") {
    for (CaseRecord& record : results.cases) {
      std::erase_if(record.measures,
                    [](const auto& m) { return m.first == "energy_left" || m.first == "energy_brought_in"; });
    }
    const std::string rest = answer_of(results);
    CHECK(rest.find("there is no ratio") != std::string::npos);
    CHECK(rest.find("%") == std::string::npos);
  }
}
