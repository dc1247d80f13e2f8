// Figures of kind `stability`, read back from the browser: what is drawn is what the cases' tables hold.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "runners/run/derive.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/synthetic_stability.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const Json& series_in(const Json& chart, const std::string& name, size_t view = 0) {
  for (const Json& one : chart.at("views")[view].at("series"))
    if (one.at("name") == name) return one;
  FAIL("no series " << name);
  static const Json none;
  return none;
}
const Json& titled(const Json& figure, const std::string& part) {
  for (const Json& chart : figure.at("charts"))
    if (chart.at("title").get<std::string>().find(part) != std::string::npos) return chart;
  FAIL("no chart " << part);
  static const Json none;
  return none;
}

/// One chart per contact state, marginal cells hollow.
void check_radii(const Json& page) {
  const Json& radii = figure(page, "spectral-radius");
  CHECK(radii.at("views") == Json({"spectral radius", "growth per step"}));
  const Json& open = titled(radii, "open");
  // Without contact the stiffness of the stops changes nothing: one curve per mass.
  const Json& full = series_in(open, "full");
  REQUIRE(full.at("data").size() == 9);
  CHECK(full["data"].back()["value"][1].get<double>() == Approx(5));
  CHECK(full["data"].back()["value"][0].get<double>() == Approx(1e-2));
  for (const Json& item : series_in(open, "poor").at("data")) CHECK(item.at("itemStyle").at("color") == "#ffffff");
  for (const Json& item : full.at("data")) CHECK_FALSE(item.contains("itemStyle"));
  // Growth is the radius less one, and absent where nothing grows.
  CHECK(series_in(open, "full", 1)["data"].back()["value"][1].get<double>() == Approx(4));
  CHECK(series_in(open, "full", 1)["data"].front()["value"][1] == "-");
  CHECK(says(open.at("views")[1].at("notes"), "No growth at any step: poor"));
  CHECK(open.at("views")[0].at("yAxis")[0].at("min") <= 0.1);
  CHECK(open.at("views")[0].at("yAxis")[0].at("max") >= 10);
}

/// A cell per step and value, and both boundaries.
void check_map(const Json& page) {
  const Json& map = figure(page, "stability-map-contact-stiffness");
  // Open cells do not depend on the stiffness: closed ones alone, per mass.
  REQUIRE(map.at("charts").size() == 2);
  std::set<std::string> names;
  for (const Json& chart : map.at("charts")) {
    CHECK_THAT(chart.at("title").get<std::string>(), StartsWith("closed"));
    size_t cells = 0, marks = 0;
    for (const Json& one : chart.at("views")[0].at("series")) {
      if (one.contains("markArea")) cells += one["markArea"].size();
      if (one.at("type") == "scatter") marks += one["data"].size();
      names.insert(one.at("name"));
    }
    CHECK(cells == 36);
    CHECK(marks == 36);
    for (const char* axis : {"xAxis", "yAxis"}) CHECK(chart.at("views")[0].at(axis)[0].at("type") == "log");
  }
  for (const Json& entry : map.at("entries")) CHECK(names.count(entry.at("name")) == 1);
  const Json &full = titled(map, "full"), &poor = titled(map, "poor");
  CHECK(full.at("views")[0].at("notes").empty());
  // Across each band of stiffness its limit: 1e-2/√κ, and never beyond that of the open structure.
  std::vector<double> limits;
  for (const Json& item : series_in(full, "predicted limit").at("data")) limits.push_back(item["value"][0]);
  REQUIRE(limits.size() == 12);
  CHECK(limits[0] == Approx(1e-3));
  CHECK(limits[3] == Approx(1e-4));
  CHECK(limits[11] == Approx(1e-6));
  REQUIRE(!poor.at("views")[0].at("notes").empty());
  CHECK_THAT(poor.at("views")[0].at("notes")[0].get<std::string>(),
             Contains("contact.stiffness 100") && Contains("predicted unstable, observed stable"));
}

}  // namespace

TEST_CASE("figures of stability draw cells and limits", "[report][browser]") {
  if (left_out()) return;
  const StudyResults results = with_tables(synthetic::stability());
  const Json pages = read_back("stability", {page_of("stability", results)});
  require_works(pages.at("stability"), results.cases.size());
  check_radii(pages.at("stability"));
  check_map(pages.at("stability"));
}
