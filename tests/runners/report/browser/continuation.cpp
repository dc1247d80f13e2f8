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
  size_t lines = 0, thin = 0, folds = 0;
  for (const browser::Json& one : branches.at("charts")[0].at("views")[0].at("series")) {
    const auto name = one.at("name").get<std::string>();
    const bool line = one.at("mark") == "line" && name.find("smooth") == 0;
    lines += line && one.at("width") > 1;
    thin += line && one.at("width") < 1;
    folds += one.at("mark") == "dots" && name.starts_with("fold");
  }
  // Of each of four methods a stable and an unstable part.
  CHECK(lines == 8);
  // Its torus has several raw crossings: there the branch is thin.
  CHECK(thin == 4);
  // Of two the fold has no name, or there is none.
  CHECK(folds >= 7);
}

/// The portrait over a whole period between the stops, what pushes over the phase, multipliers, and two commands.
void check_branch_orbit(const browser::Json& panel) {
  REQUIRE(panel.is_object());
  CHECK(panel.at("opened") == true);
  CHECK(panel.at("has") == true);
  REQUIRE(panel.at("charts").size() == 3);
  const browser::Json &portrait = panel["charts"][0], &in_time = panel["charts"][1], &plane = panel["charts"][2];
  // The curve, the strobe, two stops. Half a period is stored: the other half is minus it, and the curve is closed.
  REQUIRE(portrait.size() == 4);
  const browser::Json& curve = portrait[0].at("data");
  REQUIRE(curve.size() == 41);
  for (const size_t part : {0, 1}) {
    CHECK(curve[0]["value"][part] == curve[40]["value"][part]);
    for (size_t k = 0; k < 20; ++k)
      CHECK(curve[k]["value"][part].get<double>() == -curve[k + 20]["value"][part].get<double>());
  }
  CHECK(in_time.size() == 3);
  CHECK(plane.size() == 4);
  CHECK(panel.at("tables") == browser::Json({3}));
  REQUIRE(panel.at("commands").size() == 2);
  const std::string words =
      " --branch " + panel.at("name").get<std::string>() + " --arc " + panel.at("arc").get<std::string>();
  CHECK_THAT(panel["commands"][0].get<std::string>(),
             Catch::Matchers::StartsWith("ricochet point ") && Catch::Matchers::EndsWith(words));
  CHECK_THAT(panel["commands"][1].get<std::string>(), Catch::Matchers::EndsWith(words + " --snapshots 200"));
}

/// The fold of the smooth mass over the step falls on a line of slope 2.
void check_points(const browser::Json& page) {
  const browser::Json& points = figure(page, "points");
  size_t lines = 0;
  for (const browser::Json& chart : points.at("charts")) {
    for (const char* axis : {"xAxis", "yAxis"}) CHECK(chart.at("views")[0].at(axis)[0].at("type") == "log");
    if (chart.at("title").get<std::string>().find("fold at 0.1006 · over the step") != 0) continue;
    for (const browser::Json& one : chart.at("views")[0].at("series")) {
      if (one.at("mark") != "line" || one.at("data").size() != 2) continue;
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
  check_branch_orbit(figure(page, "branches").at("branch"));
  CHECK(figure(page, "multipliers").at("charts").size() == 8);
  CHECK(figure(page, "turns").at("charts").size() == 8);
  require_works(page, results.cases.size());
}

TEST_CASE("labels of fitted orders never lie on each other, however near their lines end", "[report][browser]") {
  if (left_out()) return;
  std::vector<Page> pages;
  for (const double spread : {0.05, 0.3}) {
    synthetic::PointLaw law;
    law.spread = spread;
    pages.push_back(
        page_of("spread-" + std::to_string(pages.size()), with_tables(synthetic::points({2000, 4000, 8000}, law))));
    pages.back().controls = false;
  }
  const browser::Json read = read_back("labels", pages);
  for (const auto& [name, page] : read.items()) {
    INFO(name);
    size_t labels = 0;
    for (const browser::Json& chart : figure(page, "points").at("charts")) {
      CHECK(chart.at("views")[0].at("collisions") == browser::Json::array());
      for (const browser::Json& one : chart.at("views")[0].at("series")) labels += one.contains("end");
    }
    CHECK(labels > 0);
  }
}
