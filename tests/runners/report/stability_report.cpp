// What the report of kind `stability` tells is what the cases' tables hold.
#include <fmt/ranges.h>

#include <catch2/catch.hpp>

#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/report/report.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/run/finish_run.hpp"
#include "tests/runners/report/synthetic_stability.hpp"

using namespace ricochet;
using namespace ricochet::report;
using Catch::Matchers::Contains;

TEST_CASE("ranges are read with what both contact states say of a cell", "[report]") {
  const CaseRecord record = synthetic::stability_case("full", 1e8, 2e-3, 1e-4, 1e-4);
  const auto open = step_range(record, false), closed = step_range(record, true);
  REQUIRE(open);
  REQUIRE(closed);
  CHECK(open->cells.size() == 9);
  CHECK(open->predicted == 2e-3);
  CHECK(closed->predicted == 1e-4);
  CHECK(closed->expected == 1e-4);
  CHECK(disagreements(*closed).empty());
  // A scene is open as well: it is expected to fail where the open structure does.
  const auto late = step_range(synthetic::stability_case("full", 1e2, 2e-4, 2e-3, 2e-4), true);
  CHECK(late->expected == 2e-4);
  CHECK(disagreements(*late).empty());
  // Seen to blow up beyond 1e-4 s, predicted beyond 1e-3 s: the steps between.
  const auto apart = disagreements(*step_range(synthetic::stability_case("poor", 1e2, 0, 1e-3, 9e-5), true));
  REQUIRE(apart.size() == 1);
  CHECK(apart[0].from == Approx(1e-4));
  CHECK(apart[0].to == Approx(1e-3));
  CHECK(apart[0].steps == 3);
  CHECK_FALSE(apart[0].predicted_unstable);
  CHECK_FALSE(step_range(CaseRecord(), false));
}

TEST_CASE("the table says limits, agreement, marginal roots", "[report]") {
  const StudyResults all = with_tables(synthetic::stability());
  const std::string html = stability_html(Choices(all));
  CHECK_THAT(html, Contains("root −1 on &lt;the kernel&gt;") && Contains("nothing to march") && Contains("none"));
  CHECK_THAT(fmt::format("{}", fmt::join(answer_lines(all), "\n")),
             Contains("Marches have another limit than the spectrum with 4 of 8"));
  CHECK(html.find("<the kernel>") == std::string::npos);
  StudyResults other;
  other.kind = "trajectory";
  CHECK(stability_html(Choices(other)).empty());
  CHECK(page_tables(Choices(other), stability_page()).empty());
}
