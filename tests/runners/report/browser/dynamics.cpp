// Figures of kinds `bifurcation` and `basins`, read back from the browser.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "runners/kinds/basins/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/run/analysed_results.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/synthetic_dynamics.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;
using report::regime_groups;

namespace {

/// Marks of packed points in a chart.
std::vector<browser::Json> sources(const browser::Json& chart, const std::string& what) {
  std::vector<browser::Json> out;
  for (const browser::Json& source : chart.at("views").at(0).at("sources"))
    if (source.at("what") == what && source.at("count") > 0) out.push_back(source);
  return out;
}
size_t count_of(const std::vector<browser::Json>& list) {
  size_t out = 0;
  for (const browser::Json& one : list) out += one.at("count").get<size_t>();
  return out;
}

/// Located changes stand at their values of the parameter.
void check_changes(const Table& table, const browser::Json& series) {
  const auto value = find_column(table.columns, "value").value();
  std::multiset<double> drawn, stored;
  for (const browser::Json& item : series.at("data")) drawn.insert(item.at("value")[0].get<double>());
  for (const auto& row : table.rows) stored.insert(row[value].number().value());
  CHECK(drawn == stored);
}

/// The portrait of the chosen orbit, its motion in time, and the section point that was clicked.
void check_orbit(const browser::Json& panel) {
  REQUIRE(panel.at("charts").size() == 2);
  const browser::Json &portrait = panel["charts"][0], &in_time = panel["charts"][1];
  REQUIRE(portrait.size() == 2);
  CHECK(portrait[0].at("mark") == "line");
  CHECK(std::any_of(portrait[1].at("data").begin(), portrait[1].at("data").end(),
                    [&](const browser::Json& dot) { return dot.at("value")[0] == panel.at("point")[1]; }));
  REQUIRE(in_time[0].at("count") == portrait[0].at("count"));
  for (size_t i = 0; i < portrait[0].at("data").size(); ++i)
    CHECK(in_time[0]["data"][i]["value"][1] == portrait[0]["data"][i]["value"][0]);
}

/// One horizontal axis for the diagram, its exponents, regimes and verdicts.
void check_diagram(const StudyResults& results, const browser::Json& page) {
  const browser::Json& diagram = figure(page, "diagram");
  CHECK(diagram.at("linked_along") == true);
  CHECK(diagram.at("views") == browser::Json({"side by side", "overlaid", "by start"}));
  const browser::Json& charts = diagram.at("charts");
  REQUIRE(charts.size() == 2 + 1 + 6);
  for (const browser::Json& chart : charts) {
    REQUIRE(chart.at("views").size() == 1);
    const browser::Json& view = chart.at("views")[0];
    const auto strips = std::count_if(view["frames"].begin(), view["frames"].end(),
                                      [](const browser::Json& frame) { return frame["pad"] > 0; });
    CHECK(strips <= 1);
    REQUIRE(view.at("xAxis").size() == static_cast<std::size_t>(4 + strips));
    for (const browser::Json& axis : view["xAxis"]) {
      CHECK(axis["min"] == view["xAxis"][0]["min"]);
      CHECK(axis["max"] == view["xAxis"][0]["max"]);
    }
    for (const browser::Json& frame : view["frames"])
      CHECK(frame["x"].get<double>() + frame["pad"].get<double>() == view["frames"][0]["x"]);
    // What did not finish stands in a strip of its own.
    for (const browser::Json& series : view["series"])
      if (series.at("name") == "not finished")
        CHECK(view["frames"][view["yAxis"][series["yAxis"].get<std::size_t>()]["frame"].get<std::size_t>()]["pad"] > 0);
  }
  // Side by side: colour is the regime; overlaid: the case.
  for (const browser::Json& source : sources(charts[0], "points"))
    CHECK(source["colour"] == regime_groups[source["group"].get<size_t>()].colour);
  std::set<std::string> colours;
  for (const browser::Json& source : sources(charts[2], "points")) colours.insert(source["colour"].get<std::string>());
  CHECK(colours.size() == 2);
  // As many points overlaid, and by start, as side by side.
  const size_t points = count_of(sources(charts[0], "points")) + count_of(sources(charts[1], "points"));
  size_t by_start = 0;
  for (size_t c = 3; c < charts.size(); ++c) by_start += count_of(sources(charts[c], "points"));
  CHECK(count_of(sources(charts[2], "points")) == points);
  CHECK(by_start == points);
  // An exponent and its interval per orbit that has one; a cell of the band per orbit.
  for (size_t c = 0; c < 2; ++c) {
    const auto orbits = orbits_of(results.cases[c]);
    const auto with =
        std::count_if(orbits.begin(), orbits.end(), [](const auto& o) { return o.largest_exponent().has_value(); });
    CHECK(count_of(sources(charts[c], "exponents")) == static_cast<size_t>(with));
    CHECK(count_of(sources(charts[c], "whiskers")) == static_cast<size_t>(with));
    CHECK(count_of(sources(charts[c], "twins")) == static_cast<size_t>(with));
    size_t cells = 0, failed = 0, changes = 0;
    for (const browser::Json& series : charts[c].at("views")[0].at("series")) {
      const std::string name = series.at("name");
      if (name.rfind("regime ", 0) == 0) cells += series.at("count").get<size_t>();
      if (name == "not finished") failed += series.at("count").get<size_t>();
      if (name == "located change") changes += series.at("count").get<size_t>();
      if (name == "located change") check_changes(results.cases[c].tables[1], series);
    }
    CHECK(cells == orbits.size());
    CHECK(failed ==
          static_cast<size_t>(std::count_if(orbits.begin(), orbits.end(), [](const auto& o) { return !o.done(); })));
    CHECK(changes == results.cases[c].tables[1].rows.size());
  }
  const browser::Json& notes = charts[0].at("views")[0].at("notes");
  CHECK(says(notes, "refused"));
  CHECK(says(notes, "the support passes the <stop>"));
  CHECK_THAT(diagram.at("caption").get<std::string>(),
             Contains("by tangent+jump") && Contains("marginal root") && Contains("All are in points.csv"));
  // Every regime and start that is drawn can be found in the legend.
  std::set<std::string> legend;
  for (const browser::Json& name : diagram.at("legend")) legend.insert(name.get<std::string>());
  for (const browser::Json& chart : charts) {
    for (const browser::Json& series : chart.at("views")[0].at("series"))
      for (const browser::Json& tag : series.value("tags", browser::Json::array()))
        CHECK(legend.count(tag.get<std::string>()) == 1);
    for (const browser::Json& source : chart.at("views")[0].at("sources"))
      for (const browser::Json& tag : source.at("tags")) CHECK(legend.count(tag.get<std::string>()) == 1);
  }
  const browser::Json& panel = diagram.at("panel");
  for (const char* what : {"opened", "orbit", "closed"}) CHECK(panel.at(what) == true);
  CHECK(panel.at("facts") > 8);
  CHECK(panel.at("canvases") > 0);
  check_orbit(panel);
  CHECK_THAT(panel.at("command").get<std::string>(), Catch::Matchers::StartsWith("ricochet point ") &&
                                                         Contains(" thr50 --parameter 0.0") && Contains(" --start "));
}

std::vector<std::pair<std::string, std::string>> regimes_and_starts(const browser::Json& page) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const browser::Json& entry : figure(page, "diagram").at("entries"))
    if (entry.value("heading", "") == "Regime" || entry.value("heading", "") == "Start")
      out.emplace_back(entry.at("name"), entry.at("colour"));
  return out;
}

/// Medians of the table, with the null level behind them.
void check_distances(const browser::Json& page) {
  const browser::Json& against = figure(page, "distance-time-beta");
  REQUIRE(against.at("charts").size() == 1);
  std::vector<double> medians;
  for (const browser::Json& item :
       items_of(against, 0, [](const browser::Json& s) { return s.value("size", browser::Json()) == 7; }))
    medians.push_back(item.at("value")[1]);
  // The cases' distances are as 1 : 2 : 3, in the order 0.25, 0.3, 0.4; so are their medians.
  REQUIRE(medians.size() == 3);
  CHECK(medians[1] == Approx(2 * medians[0]));
  CHECK(medians[2] == Approx(3 * medians[0]));
  CHECK(says(against.at("charts")[0].at("views")[0].at("notes"), "Null level: median 0.01"));
  CHECK(figure(page, "distance").at("linked_along") == true);
  for (const browser::Json& series : series_of(
           figure(page, "distance"), 0, [](const browser::Json& s) { return s.value("size", browser::Json()) == 4; }))
    CHECK(series.at("count") > 50);
  const auto level = series_of(figure(page, "distance"), 0, named("null level"));
  REQUIRE(level.size() == 1);
  for (const browser::Json& item : level[0].at("data")) CHECK(item.at("value")[1] == 0.01);
}

}  // namespace

TEST_CASE("a diagram draws every orbit, and a click on a point opens its own", "[report][browser]") {
  if (left_out()) return;
  const StudyResults results = synthetic::dynamics();
  StudyResults backward = results;
  std::reverse(backward.cases.begin(), backward.cases.end());
  for (CaseRecord& record : backward.cases)
    for (Table& table : record.tables) std::reverse(table.rows.begin(), table.rows.end());
  synthetic::DynamicsShape little, betas, many;
  little.exponents = little.portraits = little.refused = false;
  little.starts = many.starts = {"rest"};
  little.methods.resize(1);
  betas.methods = {{"three-level", 0.5}, {"three-level", 0.25}, {"three-level", 0.3}, {"three-level", 0.4}};
  StudyResults bare = synthetic::dynamics(little), pointless = synthetic::dynamics(), partial = synthetic::dynamics();
  bare.derived.clear();
  for (CaseRecord& record : pointless.cases) record.numbers.clear();
  partial.cases[1].partial = true;
  many.values = 450;
  many.kept = 600;
  many.starts = {"up"};
  many.methods.resize(1);
  const StudyResults large = synthetic::dynamics(many);
  std::vector<Page> pages = {page_of("diagram", results),
                             page_of("large", large),
                             page_of("backward", backward),
                             page_of("bare", bare),
                             page_of("betas", synthetic::dynamics(betas)),
                             page_of("pointless", pointless),
                             page_of("partial", partial)};
  for (size_t k = 2; k < pages.size(); ++k) pages[k].controls = false;
  const browser::Json said = read_back("dynamics", pages);

  require_works(said.at("diagram"), results.cases.size());
  check_diagram(results, said.at("diagram"));
  check_distances(said.at("betas"));
  require_works(said.at("large"), 1);
  CHECK(figure(said.at("large"), "diagram").at("panel").at("orbit") == true);
  CHECK(regimes_and_starts(said.at("backward")) ==
        regimes_and_starts(said.at("diagram")));  // whatever the order of values or cases

  // Without exponents, verdicts or a second case their panels and views are absent.
  const browser::Json& alone = figure(said.at("bare"), "diagram");
  CHECK(alone.at("views") == browser::Json({"diagram"}));
  REQUIRE(alone.at("charts").size() == 1);
  CHECK(alone.at("charts")[0].at("views")[0].at("xAxis").size() == 2);
  CHECK(alone.at("charts")[0].at("views")[0].at("notes").empty());
  CHECK_THAT(alone.at("caption").get<std::string>(), !Contains("exponent"));
  CHECK_FALSE(has_figure(said.at("bare"), "distance"));
  // Values without their sections still make a figure; a case that is still worked on is said to be.
  CHECK(has_figure(said.at("pointless"), "diagram"));
  CHECK_THAT(figure(said.at("partial"), "diagram").at("charts")[1].at("title").get<std::string>(),
             Contains("beta 0.25 (partial)"));
}

TEST_CASE("images of basins draw every cell and their differences, and a click opens a cell", "[report][browser]") {
  if (left_out()) return;
  const StudyResults results = with_tables(synthetic::basins(40, 0.2));
  const StudyResults filled = with_tables(
      synthetic::with_cells(synthetic::basins(20), [](CellRow& cell, size_t row) { cell.marched = row % 4 == 0; }));
  std::vector<Page> pages = {page_of("basins", results), page_of("filled", filled)};
  pages[1].controls = false;
  const browser::Json said = read_back("basins", pages);

  require_works(said.at("basins"), results.cases.size());
  const browser::Json& basins = figure(said.at("basins"), "basins");
  REQUIRE(basins.at("charts").size() == 2);
  CHECK(basins.at("views") == browser::Json({"basins", "difference"}));
  // One series per end that a case has, in the colour of the legend.
  StudyResults own = results;
  const BasinAnalysis grids = analyse_basins(own);
  for (size_t c = 0; c < 2; ++c) {
    const browser::Json& series = basins.at("charts")[c].at("views")[0].at("series");
    size_t drawn = 0;
    for (size_t k = 0; k < grids.labels.size(); ++k) {
      if (std::find(grids.images[c].cells.begin(), grids.images[c].cells.end(), k) == grids.images[c].cells.end())
        continue;
      REQUIRE(drawn < series.size());
      CHECK(series[drawn].at("name") == grids.labels[k].name);
      CHECK(series[drawn++].at("colour") == grids.labels[k].colour);
    }
    CHECK(series.size() == drawn);
  }
  const auto counts = report::basin_counts(grids).rows[1];
  CHECK(says(basins.at("charts")[1].at("views")[1].at("notes"),
             counts[4].text() + " of " + counts[7].text() + " cells that both decide differ"));
  CHECK(says(basins.at("charts")[0].at("views")[0].at("notes"), "the support passes the <stop>"));
  CHECK(basins.at("charts")[0].at("views")[0].at("xAxis")[0].at("name") == "factor of initial.displacement");
  const browser::Json& cell = basins.at("cell");
  CHECK(cell.at("opened") == true);
  CHECK(cell.at("cell") == true);
  CHECK(cell.at("lines") == 2);  // one per case
  CHECK_THAT(cell.at("command").get<std::string>(), Catch::Matchers::StartsWith("ricochet point ") &&
                                                        Contains(" --cell=" + cell.at("wanted").get<std::string>()));
  CHECK(says(figure(said.at("filled"), "basins").at("charts")[0].at("views")[0].at("notes"),
             "285 of 380 cells take the end of a marched one"));
}
