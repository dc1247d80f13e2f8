// What the report of kind `continuation` tells is what the tables of points hold.
#include <catch2/catch.hpp>

#include "runners/kinds/continuation/page/page.hpp"
#include "runners/run/finish_run.hpp"
#include "tests/runners/report/rendered.hpp"
#include "tests/runners/report/synthetic_points.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

TEST_CASE("the page has branches, points, multipliers and turns", "[report]") {
  const StudyResults all = with_tables(synthetic::points());
  const Choices choices(all);
  const PointAnalysis points(choices);
  const std::string html = report::points_html(Choices(all), points);
  CHECK_THAT(html, Contains("fold at 0.1006") && Contains("order in h") && Contains("12 without"));
  CHECK_THAT(report::point_methods_html(Choices(all), points), Contains("mesh leaves open"));
  const std::string page = synthetic::rendered(all);
  CHECK_THAT(page, Contains("point_levels") && Contains("smooth0-20-8000/branch/parameter:f64"));
}

TEST_CASE("cases that lack a point are marked where the finest of a method alone has it", "[report]") {
  const StudyResults all = synthetic::points();
  const Choices choices(all);
  const Table levels = report::point_levels(PointAnalysis(choices));
  const auto column = [&](const char* name) { return find_column(levels.columns, name).value(); };
  std::size_t absent = 0, found = 0;
  for (const Row& row : levels.rows) {
    if (row[column("refined")].text() != "elements" || row[column("name")].text().find("fold") != 0) continue;
    if (row[column("method")].text().find("rough") != 0) continue;
    const bool lacks = row[column("presence")].text() == "absent";
    CHECK(row[column("distance")].text().empty() == lacks);
    absent += lacks;
    found += !lacks;
  }
  // The rough mass has its fold on 20 elements and not on 10.
  CHECK(absent > 0);
  CHECK(found == 0);
}
