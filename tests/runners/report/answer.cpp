#include <catch2/catch.hpp>
#include <utility>

#include "runners/report/report.hpp"
#include "runners/run/asked_text.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;
using Catch::Matchers::Contains;

namespace {

/// The answer to what the cases have measured by now.
std::string answer_of(StudyResults results) {
  const AnalysedResults analysed(std::move(results));
  return answer_html(Choices(analysed), page_of_study(analysed));
}

}  // namespace

TEST_CASE("an answer is a sentence with its rows and its figure, below what warns", "[report]") {
  const std::string answer = answer_of(synthetic::results());
  CHECK_THAT(answer, Contains("<p class=\"headline\">The energy left: ") && Contains("<table class=\"verdicts\">") &&
                         Contains("<svg class=\"ask-figure\""));
  const std::size_t headline = answer.find("<p class=\"headline\">");
  for (const char* const warning :
       {"Energy is made with the consistent and the lumped mass", "2 diverged", "6 refused"}) {
    INFO(warning);
    CHECK(answer.find(warning) < headline);
  }
}

TEST_CASE("other measurements, another answer", "[report]") {
  StudyResults results = synthetic::results();
  for (CaseRecord& record : results.cases)
    for (auto& [name, value] : record.measures)
      if (name == "energy_left") value = axis_words(record, "mass") == "consistent" ? 1 : 0.5;
  CHECK_THAT(answer_of(results), Contains("from 50 % to 100 %"));
}

TEST_CASE("where nothing is brought in there is no ratio, and none is made up", "[report]") {
  StudyResults results = synthetic::results();
  for (CaseRecord& record : results.cases)
    std::erase_if(record.measures,
                  [](const auto& m) { return m.first == "energy_left" || m.first == "energy_brought_in"; });
  CHECK(answer_of(results).find("energy left") == std::string::npos);
}
