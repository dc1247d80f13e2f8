// Figures of errors, work and effects, read back from the browser: what is drawn is what the derived tables hold.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "runners/report/choices.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/evidence_results.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;

namespace {

const Table& derived_table(const StudyResults& results, const std::string& name) {
  return *std::find_if(results.derived.begin(), results.derived.end(), [&](const auto& t) { return t.name == name; });
}
bool text_contains(const browser::Json& text, const std::string& part) {
  return text.get<std::string>().find(part) != std::string::npos;
}

/// Every error is a point, every case without one a mark.
void check_errors(const StudyResults& results, const browser::Json& page) {
  const browser::Json& steps = figure(page, "error-step");
  REQUIRE(steps.at("views") == browser::Json({"tip-linf", "energy", "impact-times"}));
  CHECK_FALSE(has_figure(page, "error-elements"));  // one mesh: nothing to draw against elements
  const auto unfinished =
      std::count_if(results.cases.begin(), results.cases.end(), [](const auto& r) { return r.status != Status::done; });
  size_t drawn = 0;
  for (size_t v = 0; v < 3; ++v) {
    drawn += items_of(steps, v, is_curve).size();
    CHECK(items_of(steps, v, is_mark).size() == static_cast<size_t>(unfinished));
  }
  CHECK(drawn == derived_table(results, "errors").rows.size());
  for (const browser::Json& item : items_of(steps, 0, is_curve)) {
    // Grey exactly where the error is at or below its floor, and the tooltip says so.
    const bool below = item.at("value")[1].get<double>() <= 3e-5;
    CHECK(item.contains("colour") == below);
    CHECK(text_contains(item.at("text"), "at or below the floor") == below);
  }
  CHECK(items_of(steps, 0, named("error floor")).size() == 6);
  CHECK(items_of(steps, 2, named("error floor")).empty());  // ten decades below
  CHECK(steps.at("charts")[0].at("views")[0].at("xAxis")[0].at("type") == "log");
  CHECK(steps.at("charts")[0].at("views")[0].at("yAxis")[0].at("name") == "error tip-linf (m)");
  CHECK(steps.at("charts")[0].at("views")[0].at("xAxis")[0].at("name") == "step h (s)");
}

/// Slope lines have the fitted order and end on points.
void check_slopes(const browser::Json& page) {
  size_t lines = 0;
  for (const browser::Json& one : page.at("figures"))
    for (const browser::Json& chart : one.at("charts"))
      for (const browser::Json& view : chart.at("views")) {
        std::set<double> sizes;
        for (const browser::Json& series : view.at("series"))
          if (is_curve(series))
            for (const browser::Json& item : series.at("data")) sizes.insert(item.at("value")[0].get<double>());
        for (const browser::Json& series : view.at("series")) {
          if (!series.contains("width") || series.at("width") != 7) continue;
          ++lines;
          const browser::Json &from = series.at("data")[0].at("value"), &to = series.at("data")[1].at("value");
          const double slope = std::log(to[1].get<double>() / from[1].get<double>()) /
                               std::log(to[0].get<double>() / from[0].get<double>());
          // The label has three digits; lines that end together share one.
          if (const std::string label = series.value("end", ""); !label.empty() && !text_contains(label, " to ")) {
            const double said = std::stod(label);
            CHECK(slope == Approx(one.at("id") == "error-step" ? said : -said).epsilon(1e-2));
          }
          CHECK(sizes.count(from[0].get<double>()));
          CHECK(sizes.count(to[0].get<double>()));
          CHECK(text_contains(series.at("data")[0].at("text"), "order "));
        }
      }
  CHECK(lines > 30);
}

/// Points, spreads, gutter, fronts.
void check_work(const StudyResults& results, const browser::Json& page) {
  for (const char* id : {"work-precision", "steps-precision", "step-cost"}) CHECK(has_figure(page, id));
  const browser::Json& work = figure(page, "work-precision");
  size_t rows = 0, drawn = 0, marks = 0;
  for (const auto& row : derived_table(results, "work_precision").rows) rows += !row[8].is_nothing();
  for (size_t v = 0; v < work.at("views").size(); ++v) {
    drawn += items_of(work, v, is_curve).size();
    marks += items_of(work, v, is_mark).size();
  }
  CHECK(drawn == rows);
  CHECK(drawn + marks == derived_table(results, "work_precision").rows.size());  // nothing vanishes
  double largest = 0;
  for (const browser::Json& item : items_of(work, 0, is_curve))
    largest = std::max(largest, item.at("value")[0].get<double>());
  for (const browser::Json& item : items_of(work, 0, is_mark)) {
    CHECK(item.at("value")[0] > largest);  // in the gutter, right of every error
    CHECK(text_contains(item.at("text"), ": "));
  }
  // Finished, but without this error: said in the gutter and below.
  size_t no_such = 0;
  for (const browser::Json& item : items_of(work, 2, is_mark))
    no_such += text_contains(item.at("text"), "no such error");
  CHECK(no_such == 4);
  for (const browser::Json& chart : work.at("charts")) {
    const browser::Json& notes = chart.at("views")[2].at("notes");
    CHECK(says(notes, "4 finished cases: no such"));
    CHECK(says(notes, "⊘ refused"));
    CHECK(says(notes, "✕ diverged"));
  }
  // Bars from the fastest to the slowest repeat: two ends and a gap per point.
  const auto bars = items_of(
      work, 0, [](const browser::Json& s) { return s.at("mark") == "line" && s.value("symbol", "") == "bar"; });
  CHECK(bars.size() == 3 * items_of(work, 0, is_curve).size());
  // The front is what no other point beats, and its points are the larger ones.
  std::vector<std::pair<double, double>> all;
  std::set<std::pair<double, double>> front, large;
  for (const browser::Json& item : items_of(work, 0, is_curve)) {
    // The floor of this error is 3e-5: below it errors are not told apart.
    all.emplace_back(std::max(item.at("value")[0].get<double>(), 3e-5), item.at("value")[1].get<double>());
    if (item.contains("size")) large.insert(all.back());
    CHECK(item.contains("size") == text_contains(item.at("text"), "on the front"));
  }
  for (const auto& p : all)
    if (std::none_of(all.begin(), all.end(),
                     [&](const auto& q) { return q != p && q.first <= p.first && q.second <= p.second; }))
      front.insert(p);
  CHECK(large == front);
  std::set<std::pair<double, double>> line;
  for (const browser::Json& item : items_of(work, 0, named("Pareto front")))
    line.emplace(item.at("value")[0], item.at("value")[1]);
  CHECK(line == front);
  for (const browser::Json& one : page.at("figures"))
    for (const browser::Json& chart : one.at("charts")) CHECK(chart.at("views").size() == one.at("views").size());
  for (const browser::Json& series : series_of(work, 0, [](const browser::Json& s) { return s.at("mark") == "cells"; }))
    CHECK(series.at("said") == "no error");
}

/// Shares are bars that add up, with the table's sentence below.
void check_effects(const StudyResults& results, const browser::Json& page) {
  const browser::Json& effects = figure(page, "effects");
  REQUIRE(effects.at("charts").size() == 2);
  for (const browser::Json& chart : effects.at("charts")) {
    double sum = 0;
    size_t bars = 0;
    for (const browser::Json& series : chart.at("views")[0].at("series"))
      if (series.at("mark") == "bars")
        for (const browser::Json& item : series.at("data")) {
          sum += item.at("value")[0].get<double>();
          CHECK(says(chart.at("views")[0].at("yAxis")[0].at("data"), item.at("value")[1]));
          ++bars;
        }
    CHECK(sum == Approx(100));
    CHECK(bars == chart.at("views")[0].at("yAxis")[0].at("data").size());
  }
  CHECK(says(effects.at("charts")[0].at("views")[0].at("notes"),
             "81 % of the spread of error.tip-linf (on a logarithmic scale) comes from the step"));
  CHECK(derived_table(results, "effects").rows.size() == 16);
}

}  // namespace

TEST_CASE("figures of evidence draw the derived tables", "[report][browser]") {
  if (left_out()) return;
  const StudyResults one = synthetic::comparison(),
                     fine = synthetic::comparison({1e-3, 5e-4, 2.5e-4, 1.25e-4}, {10, 20, 40, 80}),
                     coarse = synthetic::comparison({1e-3, 1e-4}, {10, 20, 40}),
                     many = synthetic::comparison({1e-3, 1e-4}, {10, 20, 40, 80, 160});
  StudyResults silent = synthetic::comparison();
  for (Table& t : silent.derived)
    if (t.name == "effects")
      for (auto& row : t.rows) row[2] = row[3] = row[4] = 0.0;
  std::vector<Page> pages = {page_of("one", one), page_of("fine", fine), page_of("coarse", coarse),
                             page_of("many", many), page_of("silent", silent)};
  for (size_t k = 1; k < pages.size(); ++k) pages[k].controls = false;
  const browser::Json said = read_back("evidence", pages);

  require_works(said.at("one"), one.cases.size());
  check_errors(one, said.at("one"));
  check_work(one, said.at("one"));
  check_effects(one, said.at("one"));
  check_slopes(said.at("fine"));
  CHECK_FALSE(has_figure(said.at("silent"), "effects"));  // a measure without shares draws nothing

  // Errors against elements are those of the smallest step.
  std::multiset<double> drawn, expected;
  for (const browser::Json& item : items_of(figure(said.at("coarse"), "error-elements"), 0, is_curve))
    drawn.insert(item.at("value")[1].get<double>());
  for (const CaseRecord& record : coarse.cases)
    if (axis(record, "step").number() == 1e-4)
      if (const auto value = ricochet::measure(record, "error.tip-linf")) expected.insert(*value);
  CHECK(drawn == expected);

  // Charts hold at most eight methods.
  for (const char* id : {"error-step", "work-precision"})
    for (const browser::Json& chart : figure(said.at("many"), id).at("charts")) {
      std::set<std::string> names;
      for (const browser::Json& series : chart.at("views")[0].at("series")) names.insert(series.at("name"));
      names.erase("error floor");
      names.erase("Pareto front");
      CHECK(names.size() <= 8);
    }
}
