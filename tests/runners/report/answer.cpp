#include <catch2/catch.hpp>

#include "runners/kinds/trajectory/page/page.hpp"
#include "runners/report/report.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;
using Catch::Matchers::Contains;

namespace {

/// The answer to what the cases have measured by now.
std::string answer_of(StudyResults results) {
  synthetic::derive_energies(results);
  return answer_html(CaseView(results), trajectory_page());
}

}  // namespace

TEST_CASE("the first sentence of an answer is its headline, and the evidence stands below", "[report]") {
  const std::string answer = answer_of(synthetic::results());
  CHECK_THAT(answer, Contains("<p class=\"headline\">") && Contains("<strong>") && Contains("evidence"));
  CHECK_THAT(answer, Contains("singular P1") && Contains("h = 1e-6 s"));
  CHECK_THAT(answer, Contains("of 36 cases"));
}

TEST_CASE("other measurements, another answer", "[report]") {
  StudyResults results = synthetic::results();
  for (CaseRecord& record : results.cases)
    for (auto& [name, value] : record.measures)
      if (name == "energy_left") value = CaseView::text(record, "mass") == "consistent" ? 1 : 0.5;
  CHECK_THAT(answer_of(results), Contains("The consistent mass keeps it: all of the energy is left"));
}

TEST_CASE("where nothing is brought in there is no ratio, and none is made up", "[report]") {
  StudyResults results = synthetic::results();
  for (CaseRecord& record : results.cases)
    std::erase_if(record.measures,
                  [](const auto& m) { return m.first == "energy_left" || m.first == "energy_brought_in"; });
  CHECK(answer_of(results).find("energy left") == std::string::npos);
}
