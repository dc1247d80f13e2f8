// Figures of kind `continuation`, read back from the browser: what is drawn is what the tables hold.
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/run/finish_run.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/synthetic_points.hpp"

using namespace ricochet;
using namespace ricochet::browser;

namespace {

/// Eight methods at their finest in one chart, then a chart of refinements for each.
void check_branches(const browser::Json& page) {
  const browser::Json& branches = figure(page, "branches");
  CHECK(branches.at("views") == browser::Json({"finest of each method", "refined"}));
  REQUIRE(branches.at("charts").size() == 9);
  size_t lines = 0, folds = 0;
  for (const browser::Json& one : branches.at("charts")[0].at("views")[0].at("series")) {
    const auto name = one.at("name").get<std::string>();
    lines += one.at("type") == "line" && name.find("smooth") == 0;
    folds += one.at("type") == "scatter" && name.starts_with("fold");
  }
  // Of each of four methods a stable and an unstable part.
  CHECK(lines == 8);
  // Of two the fold has no name, or there is none.
  CHECK(folds >= 7);
}

/// The fold of the smooth mass over the step falls on a line of slope 2.
void check_points(const browser::Json& page) {
  const browser::Json& points = figure(page, "points");
  size_t lines = 0;
  for (const browser::Json& chart : points.at("charts")) {
    for (const char* axis : {"xAxis", "yAxis"}) CHECK(chart.at("views")[0].at(axis)[0].at("type") == "log");
    if (chart.at("title").get<std::string>().find("fold at 0.1006 · over the step") != 0) continue;
    for (const browser::Json& one : chart.at("views")[0].at("series")) {
      if (one.at("type") != "line" || one.at("data").size() != 2) continue;
      const auto at = [&](size_t k, size_t part) { return std::log(one["data"][k]["value"][part].get<double>()); };
      CHECK((at(1, 1) - at(0, 1)) / (at(1, 0) - at(0, 0)) == Approx(2).epsilon(1e-6));
      ++lines;
    }
  }
  CHECK(lines >= 4);
}

}  // namespace

TEST_CASE("figures of continuation draw branches, points, multipliers and turns", "[report][browser]") {
  if (left_out()) return;
  const StudyResults results = with_tables(synthetic::points());
  const browser::Json pages = read_back("continuation", {page_of("continuation", results)});
  const browser::Json& page = pages.at("continuation");
  check_branches(page);
  check_points(page);
  CHECK(figure(page, "multipliers").at("charts").size() == 8);
  CHECK(figure(page, "turns").at("charts").size() == 8);
  require_works(page, results.cases.size());
}
