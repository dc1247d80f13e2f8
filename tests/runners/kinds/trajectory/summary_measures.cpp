// Measures with what is open, on the page that a file keeps.
#include <catch2/catch.hpp>

#include "runners/answers/answer.hpp"
#include "runners/answers/uncertainty.hpp"
#include "runners/kinds/trajectory/page/page.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

/// One scheme at three steps, against a stop of this name; "" for stops without names.
StudyResults three_steps(const std::string& stop) {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"time", "step"};
  results.study = {{"observe", {"impulse"}}};
  results.study["scene"]["stops"] = {{"upper", 0.1}};
  const double steps[] = {4e-3, 2e-3, 1e-3}, impulses[] = {3.4, 3.1, 3.0}, forces[] = {10.4, 10.1, 10.0};
  for (int k = 0; k < 3; ++k) {
    CaseRecord& record = results.cases.emplace_back();
    record.id = "c" + std::to_string(k);
    record.status = Status::done;
    record.axes = {{"time", "newmark"}, {"step", steps[k]}};
    record.measures = {{"impulse", impulses[k]}};
    if (!stop.empty()) record.measures.emplace_back("rms_force[" + stop + "]", forces[k]);
    if (!stop.empty()) record.measures.emplace_back("peak_force[" + stop + "]", 2 * forces[k]);
  }
  const Choices study(results);
  results.derived = {answers::limits_table(study, {"impulse"}), answers::uncertainty_table(study)};
  return results;
}

std::string page(const StudyResults& results) {
  return report::summary_measures_html(Choices(results));
}

}  // namespace

TEST_CASE("a file keeps observed measures first, then those of stops, each between two values") {
  const std::string html = page(three_steps("bar"));
  // Order 1.6 of a sequence of three: its last difference stands for what the step leaves.
  CHECK_THAT(html, Contains("impulse") && Contains("2.9 to 3.1 N s") && Contains("peak force at bar"));
  CHECK(html.find("impulse") < html.find("peak force at bar"));
}

TEST_CASE("stops without names have their rows too, and a scene without stops has none") {
  StudyResults results = three_steps("");
  CHECK_THAT(page(results), Contains("2.9 to 3.1 N s") && !Contains("bar"));
  results.study["scene"]["stops"] = nullptr;
  CHECK(page(results).empty());
}

TEST_CASE("a file keeps what is asked first, and says how many measures it leaves out") {
  StudyResults results = three_steps("bar");
  for (CaseRecord& record : results.cases)
    for (int k = 0; k < 9; ++k) record.measures.emplace_back("peak_force[s" + std::to_string(k) + "]", 1.0);
  results.study["ask"] = {{{"effect", "time"}, {"on", "rms_force[bar]"}}};
  const Choices study(results);
  results.derived = {answers::limits_table(study, {"impulse"}), answers::uncertainty_table(study)};
  const std::string html = page(results);
  CHECK(html.find("rms force at bar") < html.find("impulse"));
  // Ten peaks, the impulse and what is asked.
  CHECK_THAT(html, Contains("4 more are in uncertainty.csv and limits.csv."));
  CHECK_THAT(page(three_steps("bar")), !Contains("more are in"));
}
