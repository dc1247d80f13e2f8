// Every kind of study, run by the command: what its report draws is what its tables hold.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>

#include "runners/kinds/basins/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/browser/driven.hpp"

using namespace ricochet;
using namespace ricochet::browser;

namespace {

namespace fs = std::filesystem;

struct Ran {
  StudyResults results;
  Page page;
};

/// Runs a study of tests/runners/report/studies.
Ran run(const std::string& kind) {
  const fs::path report = report_of("studies", kind);
  std::ifstream file(report, std::ios::binary);
  return {with_tables(Store(report.parent_path(), false).load()), {kind, {std::istreambuf_iterator<char>(file), {}}}};
}

const Table& stored_table(const StudyResults& results, const std::string& name) {
  const auto found =
      std::find_if(results.derived.begin(), results.derived.end(), [&](const auto& t) { return t.name == name; });
  REQUIRE(found != results.derived.end());
  return *found;
}
/// Numbers of a column of a table, in the rows that `accept` takes.
std::multiset<double> numbers_in(const Table& from, const std::string& name,
                                 const std::function<bool(const Row&)>& accept) {
  const auto place = find_column(from.columns, name);
  REQUIRE(place);
  std::multiset<double> out;
  for (const auto& row : from.rows)
    if (accept(row) && row[*place].number()) out.insert(*row[*place].number());
  return out;
}
std::multiset<double> heights(const std::vector<browser::Json>& items) {
  std::multiset<double> out;
  for (const browser::Json& item : items)
    if (item.at("value")[1].is_number()) out.insert(item.at("value")[1].get<double>());
  return out;
}

void check_trajectory(const Ran& ran, const browser::Json& page) {
  std::multiset<double> ratios, changes;
  size_t samples = 0, drawn = 0;
  for (const CaseRecord& record : ran.results.cases) {
    if (!record.curve.columns.empty()) samples += record.curve.columns[0].size();
    if (record.status != Status::done) continue;
    if (const auto ratio = ricochet::measure(record, "energy_left")) {
      ratios.insert(*ratio);
      if (*ratio != 1) changes.insert(std::abs(*ratio - 1));
    }
  }
  const browser::Json& energy = figure(page, "final-energy-step");
  for (size_t v = 0; v < energy.at("views").size(); ++v) {
    if (energy.at("views")[v] == "E(T) / E_in") CHECK(heights(items_of(energy, v, is_curve)) == ratios);
    if (energy.at("views")[v] == "|E(T) / E_in − 1|") CHECK(heights(items_of(energy, v, is_curve)) == changes);
  }
  for (const browser::Json& series : series_of(figure(page, "tip"), 0, [](const browser::Json& s) {
         return s.at("mark") == "line" && s.at("name") != "stops";
       }))
    drawn += series.at("count").get<size_t>();
  CHECK(drawn == samples);
}

void check_errors(const Ran& ran, const browser::Json& page) {
  const Table& errors = stored_table(ran.results, "errors");
  const browser::Json& steps = figure(page, "error-step");
  const auto kind = find_column(errors.columns, "error").value();
  for (size_t v = 0; v < steps.at("views").size(); ++v) {
    std::multiset<double> values = numbers_in(
        errors, "value", [&](const auto& row) { return row[kind] == steps.at("views")[v].get<std::string>(); });
    values.erase(0.0);  // said below the chart: a logarithmic axis has no place for it
    CHECK(heights(items_of(steps, v, is_curve)) == values);
  }
  for (const browser::Json& series : series_of(steps, 0, [](const browser::Json& s) { return s.contains("end"); }))
    CHECK(series.at("data").size() == 2);
}

void check_work(const Ran& ran, const browser::Json& page) {
  const Table &work = stored_table(ran.results, "work_precision"), &points = stored_table(ran.results, "work_points");
  const browser::Json& times = figure(page, "work-precision");
  size_t drawn = 0, marks = 0, on_front = 0;
  for (size_t v = 0; v < times.at("views").size(); ++v) {
    drawn += items_of(times, v, is_curve).size();
    marks += items_of(times, v, is_mark).size();
    for (const browser::Json& item : items_of(times, v, is_curve)) on_front += item.contains("size");
  }
  // Each figure has its own column of the table on the vertical axis.
  const auto at = [&](const char* name) { return find_column(points.columns, name).value(); };
  for (const auto& [id, column] :
       {std::pair("work-precision", "seconds"), {"steps-precision", "steps"}, {"step-cost", "microseconds"}})
    for (size_t v = 0; v < figure(page, id).at("views").size(); ++v)
      CHECK(heights(items_of(figure(page, id), v, is_curve)) ==
            numbers_in(points, column, [&, id = id](const auto& row) {
              return row[at("error")].text() == figure(page, id).at("views")[v] && row[at("none")].text().empty();
            }));
  // A kind of error that no case has is no view.
  const std::size_t kind = find_column(work.columns, "error").value();
  CHECK(drawn + marks == static_cast<size_t>(std::count_if(work.rows.begin(), work.rows.end(), [&](const auto& row) {
          const browser::Json views = times.at("views");
          return std::find(views.begin(), views.end(), row[kind].text()) != views.end();
        })));
  CHECK(on_front == static_cast<size_t>(std::count_if(points.rows.begin(), points.rows.end(),
                                                      [&](const auto& row) { return row[at("on_front")] == true; })));
  CHECK(on_front > 0);
}

void check_stability(const Ran& ran, const browser::Json& page) {
  const Table& cells = stored_table(ran.results, "stability_cells");
  const browser::Json& radii = figure(page, "spectral-radius");
  size_t closed = 0;
  for (const browser::Json& chart : radii.at("charts"))
    if (chart.at("title").get<std::string>().rfind("closed", 0) == 0)
      for (const browser::Json& series : chart.at("views")[0].at("series"))
        if (series.at("name") != "unit circle" && series.at("mark") == "line")
          for (const browser::Json& item : series.at("data")) closed += item.at("value")[1].is_number();
  CHECK(closed == numbers_in(cells, "radius", [](const auto& row) { return row[1] == true; }).size());
  CHECK(closed > 0);
  const browser::Json& map = figure(page, "stability-map-time-beta");
  for (const browser::Json& chart : map.at("charts")) {
    size_t areas = 0, marks = 0;
    for (const browser::Json& series : chart.at("views")[0].at("series")) {
      if (series.at("mark") == "cells") areas += series.at("count").get<size_t>();
      if (series.at("mark") == "dots") marks += series.at("count").get<size_t>();
    }
    CHECK(areas == marks);
    CHECK(areas > 0);
  }
}

void check_bifurcation(const Ran& ran, const browser::Json& page) {
  const browser::Json& diagram = figure(page, "diagram");
  for (size_t c = 0; c < ran.results.cases.size(); ++c) {
    const auto orbits = orbits_of(ran.results.cases[c]);
    size_t cells = 0;
    std::multiset<double> drawn, stored;
    for (const browser::Json& series : diagram.at("charts")[c].at("views")[0].at("series"))
      if (series.at("name").get<std::string>().rfind("regime ", 0) == 0) cells += series.at("count").get<size_t>();
    CHECK(cells == orbits.size());
    for (const browser::Json& source : diagram.at("charts")[c].at("views")[0].at("sources"))
      if (source.at("what") == "exponents")
        for (size_t k = 1; k < source.at("values").size(); k += 2) drawn.insert(source.at("values")[k].get<double>());
    for (const auto& orbit : orbits)
      if (orbit.largest_exponent()) stored.insert(*orbit.largest_exponent());
    CHECK(drawn == stored);
  }
  const Table& spreads = stored_table(ran.results, "distance_spreads");
  const browser::Json& against = figure(page, "distance-time-beta");
  const std::string reference = spreads.rows[0][2].text();
  auto medians = numbers_in(spreads, "median", [&](const auto& row) {
    return row[1] == "wasserstein" && !row[0].text().empty() && row[0].text() != reference;
  });
  medians.erase(0.0);
  CHECK(heights(items_of(against, 0, [](const browser::Json& s) { return s.value("size", browser::Json()) == 7; })) ==
        medians);
}

void check_basins(const Ran& ran, const browser::Json& page) {
  StudyResults results = ran.results;
  const BasinAnalysis grids = analyse_basins(results);
  const browser::Json& basins = figure(page, "basins");
  REQUIRE(basins.at("charts").size() == grids.images.size());
  for (size_t c = 0; c < grids.images.size(); ++c) {
    std::set<int> labels(grids.images[c].cells.begin(), grids.images[c].cells.end());
    labels.erase(report::BasinImage::absent);
    CHECK(basins.at("charts")[c].at("views")[0].at("series").size() == labels.size());
    // Each image spans the frame.
    const browser::Json& view = basins.at("charts")[c].at("views")[0];
    const browser::Json &x = view.at("xAxis")[0], &y = view.at("yAxis")[0];
    for (const browser::Json& series : view.at("series"))
      CHECK((series.at("x") == browser::Json({x.at("min"), x.at("max")}) &&
             series.at("y") == browser::Json({y.at("min"), y.at("max")})));
  }
  for (const auto& row : stored_table(ran.results, "basin_differences").rows)
    CHECK(says(basins.at("charts")[1].at("views")[1].at("notes"),
               row[3].text() + " of " + row[2].text() + " cells that both decide differ"));
}

}  // namespace

TEST_CASE("reports of studies of every kind draw what their tables hold, and every dot is a door to its case",
          "[report][browser]") {
  if (left_out()) return;
  std::map<std::string, Ran> ran;
  std::vector<Page> pages;
  for (const char* kind : {"trajectory", "convergence", "work-precision", "stability", "bifurcation", "basins"}) {
    INFO(kind);
    pages.push_back(ran.emplace(kind, run(kind)).first->second.page);
  }
  const browser::Json said = read_back("results", pages);
  for (const auto& [kind, one] : ran) {
    INFO(kind);
    require_works(said.at(kind), one.results.cases.size());
    require_doors(said.at(kind), kind);
    // No chart of the kind stands beside answers that have figures of their own.
    CHECK(said.at(kind).at("answer").empty());
    if (const browser::Json& word = said.at(kind).at("explained"); !word.is_null()) {
      CHECK(word.at("label").get<std::string>().rfind("What “", 0) == 0);
      CHECK(word.at("text").get<std::string>().size() > 40);
      CHECK(word.at("closed") == true);
    }
  }
  CHECK(std::any_of(ran.begin(), ran.end(),
                    [&](const auto& one) { return said.at(one.first).at("explained").is_object(); }));
  // What the page holds of a trajectory: its curves, its portrait, its impacts, its ledger.
  const browser::Json& door = figure(said.at("trajectory"), "tip").at("door");
  CHECK(door.at("plots") == 4);
  for (const char* part : {"Phase portrait", "Measures", "Impacts", "Where its energy came from and went"})
    CHECK(says(door.at("headings"), part));
  check_trajectory(ran.at("trajectory"), said.at("trajectory"));
  check_errors(ran.at("convergence"), said.at("convergence"));
  check_errors(ran.at("work-precision"), said.at("work-precision"));
  check_work(ran.at("work-precision"), said.at("work-precision"));
  check_stability(ran.at("stability"), said.at("stability"));
  check_bifurcation(ran.at("bifurcation"), said.at("bifurcation"));
  check_basins(ran.at("basins"), said.at("basins"));
}
