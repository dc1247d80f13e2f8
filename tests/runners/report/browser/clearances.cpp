// Orbits within clearances, read back from the browser.
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/kinds/trajectory/outputs.hpp"
#include "tests/runners/report/browser/browser.hpp"

using namespace ricochet;
using namespace ricochet::browser;

namespace {

constexpr int dots = 100;

/// Two masses, each with a place that goes round in two clearances; radius 1e-3 m.
StudyResults rounds() {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"mass", "step"};
  for (const char* mass : {"consistent", "singular"}) {
    CaseRecord record;
    record.id = mass;
    record.axes = {{"mass", mass}, {"step", 1e-5}};
    record.status = Status::done;
    NumberTable orbits = orbits_type().head();
    orbits.words = {{"stop", {"plate", "grid"}}};
    for (int i = 0; i < 2 * dots; ++i)
      orbits.add({static_cast<double>(i / dots), 0.01 * i, 1e-3 * std::cos(0.1 * i), 1e-3 * std::sin(0.1 * i), 1e-3});
    record.numbers.push_back(orbits);
    results.cases.push_back(record);
  }
  return results;
}

}  // namespace

TEST_CASE("a clearance is a chart with a circle and a dot per sample, on one scale", "[report][browser]") {
  if (left_out()) return;
  const browser::Json pages = read_back("clearances", {page_of("clearances", rounds())});
  const browser::Json& orbits = figure(pages.at("clearances"), "clearances");
  REQUIRE(orbits.at("charts").size() == 2);
  for (const char* mass : {"consistent", "singular"}) CHECK(items_of(orbits, 0, named(mass)).size() == 2 * dots);
  const auto circle = items_of(orbits, 0, named("clearance"));
  REQUIRE(circle.size() == 2 * 91);
}
