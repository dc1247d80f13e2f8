// A report does not grow with its study: a thousand cases, read back from the browser.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::browser;

TEST_CASE("a study of a thousand cases has a page of a few screens", "[report][browser]") {
  if (left_out()) return;
  synthetic::Shape shape;
  shape.repeat = 27;
  const StudyResults results = synthetic::results(shape);
  REQUIRE(results.cases.size() == 972);
  const Page page = page_of("many", results);
  CHECK(page.html.size() < 3'000'000);  // of which the chart library is 1.1 MB
  const Json said = read_back("many", {page}).at("many");
  CHECK(said.at("height") < 12 * 900);
  CHECK(said.at("nodes") < 45'000);  // 972 rows of the table of cases, and a cell of each map for each
  std::size_t maps = 0;
  for (const Json& one : said.at("figures")) {
    INFO(one.at("id"));
    CHECK(one.at("charts").size() <= 24);
    if (!one.contains("map")) continue;
    ++maps;
    CHECK(one.at("map").at("cells") == results.cases.size());
    CHECK(one.at("map").at("rows") <= 60);
    CHECK(one.at("map").at("marks") > 0);  // what has no result says so without colour
    for (const Json& charts : one.at("map").at("charts")) CHECK((charts > 0 && charts <= 24));
  }
  // The energy at the end and over time share a map; tip, force, penetration and impacts have their own.
  CHECK(maps == 5);
  CHECK(said.at("table").at("rows") == results.cases.size());
}
