#include "runners/report/answer.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;

namespace {
bool starts(const Trend& trend, const char* words) {
  return trend.words.rfind(words, 0) == 0;
}
}  // namespace

TEST_CASE("a trend is told from the measured ratios", "[report]") {
  const std::vector<double> steps = {1e-4, 1e-5, 1e-6};
  CHECK(starts(step_trend(steps, {1, 1 + 1e-13, 1 - 1e-13}, 1e-12), "kept to the noise floor"));
  CHECK(starts(step_trend(steps, {0.9, 0.99, 0.999}, 1e-12), "comes closer"));
  CHECK(starts(step_trend(steps, {0.9, 0.8, 0.6}, 1e-12), "loses more"));
  CHECK(starts(step_trend(steps, {1.5, 2.5, 9}, 1e-12), "gains more"));
  CHECK(starts(step_trend(steps, {0.8, 0.71, 0.7099}, 1e-12), "settles near 70.99 %"));
  CHECK(starts(step_trend(steps, {0.721, 0.723, 0.722}, 1e-12), "the same change at every step"));
  CHECK(starts(step_trend(steps, {0.9, 0.7, 0.95}, 1e-12), "no steady trend"));
  CHECK(starts(step_trend(steps, {0.9, 0.99, 1}, 1e-12), "reaches its start"));
  CHECK(starts(step_trend({1e-4}, {0.9}, 1e-12), "one step only"));
  CHECK(starts(step_trend({}, {}, 1e-12), "no finished case"));
}

TEST_CASE("the order of a trend is that of a power law", "[report]") {
  for (const double order : {0.5, 1.0, 2.0}) {
    const std::vector<double> steps = {1e-3, 2e-4, 1e-4};
    std::vector<double> ratios, damped;
    for (const double h : steps) ratios.push_back(1 - std::pow(h, order));
    // 1 − (1 − x) loses at most 2⁻⁵³ of x ≥ 1e-8, hence 1e-8 of the logarithm's argument
    CHECK(step_trend(steps, ratios, 1e-15).order.value() == Approx(order).margin(1e-6));
    const std::vector<double> even = {4e-4, 2e-4,
                                      1e-4};  // the moves of a power law follow it only for a constant ratio of steps
    for (const double h : even) damped.push_back(0.43 - std::pow(h, order));
    CHECK(step_trend(even, damped, 1e-15, false).order.value() == Approx(order).margin(1e-6));
  }
}

TEST_CASE("the answer's figures are those of the results", "[report]") {
  StudyResults results = synthetic::results();
  const std::string answer = answer_html(CaseView(results));
  const auto says = [&](const std::string& text) { return answer.find(text) != std::string::npos; };
  double low = INFINITY, high = 0;
  for (const CaseRecord& record : results.cases)
    if (record.status == "done" && CaseView::text(record, "mass.velocity") == "P1") {
      low = std::min(low, *CaseView::measure(record, "energy_ratio"));
      high = std::max(high, *CaseView::measure(record, "energy_ratio"));
    }
  CHECK(low < high);
  CHECK(says("over 6 finished cases the energy ends at 99.60 % to 99.9960 % of its start"));
  CHECK(says("closest to its starting energy is <strong>singular, velocity P1"));
  CHECK(says("In 2 of 8 cases single steps gain energy, at most 5 %"));
  CHECK(says("1 diverged"));
  CHECK(says("3 refused"));
  CHECK(says("diverged at 1e-6"));

  SECTION("other measurements, other words") {
    for (CaseRecord& record : results.cases)
      for (auto& [name, value] : record.measures)
        if (name == "energy_ratio") value = CaseView::text(record, "mass") == "consistent" ? 1 : 0.5;
    const std::string changed = answer_html(CaseView(results));
    CHECK(changed.find("closest to its starting energy is <strong>consistent") != std::string::npos);
    CHECK(changed.find("8 of 28 finished cases over all steps end where they began") != std::string::npos);
  }
  SECTION("where damping works, the start is no reference") {
    for (CaseRecord& record : results.cases)
      for (auto& [name, value] : record.measures)
        if (name == "work_of_damping") value = -0.4;
    const std::string damped = answer_html(CaseView(results));
    CHECK(damped.find("closest to its starting energy") == std::string::npos);
    CHECK(damped.find("damping −0.4 to −0.4 J. What went") != std::string::npos);
    CHECK(damped.find("Contact took") != std::string::npos);
  }
  SECTION("from rest there is no ratio, and none is made up") {
    for (CaseRecord& record : results.cases) {
      std::erase_if(record.measures,
                    [](const auto& m) { return m.first == "energy_ratio" || m.first == "energy_start"; });
    }
    const std::string rest = answer_html(CaseView(results));
    CHECK(rest.find("there is no ratio") != std::string::npos);
    CHECK(rest.find("%") == std::string::npos);
  }
}

TEST_CASE("the noise floor is round-off or the balance's residual, whichever is larger", "[report]") {
  CaseRecord record;
  record.steps = 1 << 20;
  CHECK(noise_of(record) == std::ldexp(1.0, -32));
  record.measures = {{"energy_start", 2}, {"balance_residual", -1e-3}};
  CHECK(noise_of(record) == 5e-4);
}
