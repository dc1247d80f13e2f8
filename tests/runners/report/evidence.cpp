// The report's evidence: what is drawn and told is what the derived tables hold.
#include "runners/report/evidence.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <set>

#include "runners/report/evidence_rows.hpp"
#include "runners/report/work_precision.hpp"
#include "tests/runners/report/evidence_results.hpp"

using namespace ricochet;
using namespace ricochet::report;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const Figure& find(const std::vector<Figure>& figures, const std::string& id) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.id == id; });
  REQUIRE(found != figures.end());
  return *found;
}

using Accept = std::function<bool(const Json& series)>;

/// Points of the series that `accept` takes, over the charts of a figure in one view.
std::vector<Json> points(const Figure& figure, size_t view, const Accept& accept) {
  std::vector<Json> out;
  for (const Chart& chart : figure.charts)
    for (const Json& series : chart.views.at(view).option.at("series"))
      if (accept(series))
        for (const Json& item : series.at("data")) out.push_back(item);
  return out;
}

bool is_curve(const Json& series) {
  return series.at("type") == "line" && series.value("symbolSize", Json()) == 8;
}
bool is_mark(const Json& series) {
  return series.at("type") == "scatter";
}
Accept named(const std::string& name) {
  return [name](const Json& series) { return series.at("name") == name; };
}

/// Every number of a page's options is one: NaN would be written as null.
bool has_null(const Json& value) {
  if (value.is_null()) return true;
  if (value.is_number_float()) return !std::isfinite(value.get<double>());
  return value.is_structured() && std::any_of(value.begin(), value.end(), [](const Json& v) { return has_null(v); });
}

std::vector<Figure> all_figures(const CaseView& view) {
  std::vector<Figure> out;
  for (const auto maker : {error_figures, work_precision_figures, effects_figures})
    for (Figure& figure : maker(view)) out.push_back(std::move(figure));
  return out;
}

const Table& table(const StudyResults& results, const std::string& name) {
  return *std::find_if(results.derived.begin(), results.derived.end(), [&](const auto& t) { return t.name == name; });
}

size_t unfinished(const StudyResults& results) {
  return static_cast<size_t>(
      std::count_if(results.cases.begin(), results.cases.end(), [](const auto& r) { return r.status != "done"; }));
}

}  // namespace

TEST_CASE("without derived tables there is no evidence", "[report]") {
  const StudyResults results = synthetic::results();
  const CaseView view(results);
  CHECK(all_figures(view).empty());
  CHECK(orders_html(view).empty());
  CHECK(work_precision_html(view).empty());
  CHECK(effects_html(view).empty());
}

TEST_CASE("rows are found by the axes of a case", "[report]") {
  const StudyResults results = synthetic::comparison({1e-3, 5e-4}, {10, 20});
  const EvidenceRows errors(results, "errors", {"error"}), orders(results, "orders", {"refined", "error"});
  for (const CaseRecord& record : results.cases) {
    const auto row = errors.find(record, {"energy"});
    CHECK(row.has_value() == CaseView::measure(record, "error.energy").has_value());
    if (row) CHECK(errors.number(*row, "value") == CaseView::measure(record, "error.energy"));
    CHECK_FALSE(errors.find(record, {"no such"}));
    const auto order = orders.find(record, {"elements", "energy"}, {"elements"});
    if (order) CHECK(orders.text(*order, "elements").empty());
    CHECK(order.has_value() == (record.status != "refused"));
  }
  CHECK(errors.text(0, "no such column").empty());
  CHECK(EvidenceRows(results, "no such table").empty());
}

TEST_CASE("every error is a point, every case without one a mark", "[report]") {
  const StudyResults results = synthetic::comparison();
  const CaseView view(results);
  const auto figures = error_figures(view);
  const Figure& figure = find(figures, "error-step");
  REQUIRE(figure.views == std::vector<std::string>{"tip-linf", "energy", "impact-times"});
  CHECK(figures.size() == 1);  // one mesh: nothing to draw against elements
  size_t drawn = 0;
  for (size_t v = 0; v < figure.views.size(); ++v) {
    drawn += points(figure, v, is_curve).size();
    CHECK(points(figure, v, is_mark).size() == unfinished(results));
  }
  CHECK(drawn == table(results, "errors").rows.size());
  for (const Json& item : points(figure, 0, is_curve)) {
    // Grey exactly where the error is at or below its floor, and the tooltip says so.
    const bool below = item.at("value")[1].get<double>() <= 3e-5;
    CHECK(item.contains("itemStyle") == below);
    CHECK(contains(item.at("text"), "at or below the floor") == below);
  }
  CHECK(points(figure, 0, named("error floor")).size() == 6);
  CHECK(points(figure, 2, named("error floor")).empty());  // ten decades below
  for (const Chart& chart : figure.charts)
    for (const ChartView& one : chart.views) CHECK_FALSE(has_null(one.option));
}

TEST_CASE("slope lines have the fitted order and end on points", "[report]") {
  const StudyResults results = synthetic::comparison({1e-3, 5e-4, 2.5e-4, 1.25e-4}, {10, 20, 40, 80});
  const CaseView view(results);
  const EvidenceRows orders(results, "orders");
  size_t lines = 0;
  for (const Figure& figure : error_figures(view))
    for (const Chart& chart : figure.charts)
      for (const ChartView& one : chart.views) {
        std::set<double> sizes;
        for (const Json& series : one.option.at("series"))
          if (is_curve(series))
            for (const Json& item : series.at("data")) sizes.insert(item.at("value")[0].get<double>());
        for (const Json& series : one.option.at("series")) {
          if (!series.contains("endLabel")) continue;
          ++lines;
          const Json &from = series.at("data")[0].at("value"), &to = series.at("data")[1].at("value");
          const double slope = std::log(to[1].get<double>() / from[1].get<double>()) /
                               std::log(to[0].get<double>() / from[0].get<double>());
          const double said = std::stod(series.at("endLabel").at("formatter").get<std::string>());
          // The label has three digits.
          CHECK(slope == Approx(figure.id == "error-step" ? said : -said).epsilon(1e-2));
          CHECK(sizes.count(from[0].get<double>()));
          CHECK(sizes.count(to[0].get<double>()));
          CHECK(contains(series.at("data")[0].at("text"), "order "));
        }
      }
  CHECK(lines > 30);
}

TEST_CASE("errors against elements are those of the smallest step", "[report]") {
  const StudyResults results = synthetic::comparison({1e-3, 1e-4}, {10, 20, 40});
  const CaseView view(results);
  const auto figures = error_figures(view);
  std::multiset<double> drawn, expected;
  for (const Json& item : points(find(figures, "error-elements"), 0, is_curve))
    drawn.insert(item.at("value")[1].get<double>());
  for (const CaseRecord& record : results.cases)
    if (CaseView::number(record, "step") == 1e-4)
      if (const auto value = CaseView::measure(record, "error.tip-linf")) expected.insert(*value);
  CHECK(drawn == expected);
}

TEST_CASE("charts of evidence hold at most eight methods", "[report]") {
  const StudyResults results = synthetic::comparison({1e-3, 1e-4}, {10, 20, 40, 80, 160});
  const CaseView view(results);
  const std::vector<Figure> figures = all_figures(view);
  for (const char* id : {"error-step", "work-precision"})
    for (const Chart& chart : find(figures, id).charts) {
      std::set<std::string> names;
      for (const Json& series : chart.views.at(0).option.at("series")) names.insert(series.at("name"));
      names.erase("error floor");
      names.erase("Pareto front");
      CHECK(names.size() <= 8);
    }
}

TEST_CASE("the Pareto front is what nothing beats", "[report]") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0.1, 1);
  const auto seconds = [](const WorkPoint& p) { return p.seconds; };
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<WorkPoint> all(30);
    for (WorkPoint& p : all) {
      // Coarse values, so that ties happen.
      p.error = std::round(10 * uniform(random)) / 10;
      p.seconds = std::round(10 * uniform(random)) / 10;
      p.low = 0.9 * p.seconds;
      p.high = 1.3 * p.seconds;
      p.floor = 0.25;
    }
    const std::vector<size_t> front = pareto_front(all, seconds);
    for (size_t k = 0; k < all.size(); ++k) {
      const bool beaten = std::any_of(all.begin(), all.end(), [&](const WorkPoint& other) {
        return other.known() <= all[k].known() && other.seconds <= all[k].seconds &&
               (other.known() < all[k].known() || other.seconds < all[k].seconds);
      });
      CHECK(beaten == (std::find(front.begin(), front.end(), k) == front.end()));
      // What is told from the front is beaten; what is on it never is.
      if (told_from_front(all[k], all)) CHECK(beaten);
    }
    for (size_t k = 1; k < front.size(); ++k) CHECK(all[front[k - 1]].known() <= all[front[k]].known());
  }
}

TEST_CASE("work and precision: points, spreads, gutter", "[report]") {
  const StudyResults results = synthetic::comparison();
  const CaseView view(results);
  const auto figures = work_precision_figures(view);
  REQUIRE(figures.size() == 3);
  const Figure& figure = find(figures, "work-precision");
  size_t rows = 0;
  for (const auto& row : table(results, "work_precision").rows) rows += !row[8].is_nothing();
  size_t drawn = 0, marks = 0;
  for (size_t v = 0; v < figure.views.size(); ++v) {
    drawn += points(figure, v, is_curve).size();
    marks += points(figure, v, is_mark).size();
  }
  CHECK(drawn == rows);
  CHECK(drawn + marks == table(results, "work_precision").rows.size());  // nothing vanishes
  for (const Json& item : points(figure, 0, is_mark)) {
    CHECK(item.at("value")[0].is_string());  // a slot of the gutter, no error that could be read off
    CHECK(contains(item.at("text"), ": "));
  }
  // Finished, but without this error: said in the gutter and below.
  size_t no_such = 0;
  for (const Json& item : points(figure, 2, is_mark)) no_such += contains(item.at("text"), "no such error");
  CHECK(no_such == 4);
  for (const Chart& chart : figure.charts) {
    const auto& notes = chart.views[2].notes;
    CHECK(std::any_of(notes.begin(), notes.end(),
                      [](const auto& n) { return contains(n, "4 finished cases: no such"); }));
    CHECK(chart.notes.size() == 2);  // one refusal, one divergence
  }
  // Bars from the fastest to the slowest repeat: two ends and a gap per point.
  const auto bars = points(figure, 0, [](const Json& series) {
    return series.at("type") == "line" && series.at("symbol") == "rect" && series.at("symbolSize").is_array();
  });
  CHECK(bars.size() == 3 * points(figure, 0, is_curve).size());
  for (const Figure& one : figures)
    for (const Chart& chart : one.charts) {
      CHECK(chart.views.size() == one.views.size());
      for (const ChartView& v : chart.views) CHECK_FALSE(has_null(v.option));
    }
}

TEST_CASE("the cheapest method is the one that a search over all cases finds", "[report]") {
  const StudyResults results = synthetic::comparison();
  const CaseView view(results);
  const std::string html = work_precision_html(view);
  const WorkPrecision work(view);
  for (const std::string& error : work.errors()) {
    const auto points = work.points(view.all(), error);
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      const WorkPoint* best = nullptr;
      for (const WorkPoint& p : points)
        if (p.known() <= tolerance && (!best || p.seconds < best->seconds)) best = &p;
      // Where every case gets there, there is nothing to say.
      const bool all = std::all_of(points.begin(), points.end(), [&](const auto& p) { return p.known() <= tolerance; });
      if (!best || all) continue;
      INFO(error << " " << tolerance);
      const std::string row = "<td class=\"text\">" + with_unit({error, error_quantity(error).unit}) +
                              "</td><td class=\"number\">" + power_text(tolerance) + "</td><td>" +
                              view.label(*best->record, view.varying_without({"step"})) + "</td>";
      CHECK(contains(html, row));
    }
  }
  CHECK(contains(html, " ×</td>"));
  CHECK(contains(html, ">overlap</td>"));
  CHECK(contains(html, "where the spreads overlap, the two are not told apart"));
}

TEST_CASE("an error below its floor wins nothing", "[report]") {
  // Two methods, one a thousand times below the floor, neither told from the other by precision.
  const double floor = 1e-3;
  const WorkPoint lucky{nullptr, 1e-6, 2, 2, 2, 10, floor}, honest{nullptr, 0.9e-3, 1, 1, 1, 10, floor};
  const auto front = pareto_front({lucky, honest}, [](const WorkPoint& p) { return p.seconds; });
  CHECK(front == std::vector<size_t>{1});
}

TEST_CASE("orders are a table with verdicts counted", "[report]") {
  const StudyResults results = synthetic::comparison({1e-3, 5e-4}, {10, 20});
  const CaseView view(results);
  const std::string html = orders_html(view);
  // 5 schemes, 3 errors, 2 meshes; of them one scheme has order 2 where 1 is declared.
  CHECK(contains(html, "30 orders against what the methods declare: 24 confirmed, 6 refuted."));
  CHECK(contains(html, "0.97 [0.90, 1.08]"));
  CHECK(contains(html, "agrees with the declared 1; 6 of 6 points &lt;all&gt;"));
  CHECK(contains(html, "<td>elements</td>"));
  // A matrix of 5 schemes × (2 meshes + the refinement of the mesh), then every row of the table by itself.
  size_t rows = 0;
  for (size_t at = 0; (at = html.find("<tr><th scope=\"row\">", at)) != std::string::npos; ++at) ++rows;
  CHECK(rows == 15 + table(results, "orders").rows.size());
  CHECK(contains(html, ">0.97 ✓</td>"));
  CHECK(contains(html, ">1.97 ✕</td>"));
  CHECK(html.find(">refuted</td>") < html.find(">undecided</td>"));
  CHECK(html.find(">undecided</td>") < html.find(">confirmed</td>"));
  // A row without an order.
  StudyResults none = results;
  for (Table& t : none.derived) {
    if (t.name == "orders")
      for (auto& row : t.rows) row[8] = row[9] = row[10] = row[11] = nullptr;
    if (t.name == "order_verdicts") t = order_verdicts_table(table(none, "orders"));
  }
  CHECK(contains(orders_html(CaseView(none)), "none with a declared order"));
}

TEST_CASE("effects are sentences and bars", "[report]") {
  const StudyResults results = synthetic::comparison();
  const CaseView view(results);
  const std::string html = effects_html(view);
  CHECK(contains(html,
                 "81 % of the spread of error.tip-linf (on a logarithmic scale) comes from the step, 9 % from the mass "
                 "matrix, 5.5 % from its interaction with the mass matrix."));
  CHECK(contains(
      html,
      "86 % of the spread of energy end comes from the mass matrix, 8 % from its interaction with the step, 2.5 % "
      "from the time scheme."));
  CHECK(contains(html, "7 of 36 cases have no value (6 refused, 1 diverged); what they would be is estimated"));
  CHECK(contains(html, "One level only, so no share: contact."));
  const auto figures = effects_figures(view);
  REQUIRE(figures.size() == 1);
  REQUIRE(figures[0].charts.size() == 2);
  for (const Chart& chart : figures[0].charts) {
    double sum = 0;
    for (const Json& series : chart.views.at(0).option.at("series"))
      if (series.at("type") == "bar")
        for (const Json& item : series.at("data")) sum += item.at("value")[0].get<double>();
    CHECK(sum == Approx(100));
    CHECK_FALSE(has_null(chart.views[0].option));
  }
}

TEST_CASE("a measure without shares says so and draws nothing", "[report]") {
  StudyResults results = synthetic::comparison();
  for (Table& t : results.derived)
    if (t.name == "effects")
      for (auto& row : t.rows) row[2] = row[3] = row[4] = 0.0;
  const CaseView view(results);
  CHECK(effects_figures(view).empty());
  CHECK(contains(effects_html(view), "No shares for energy end."));
}

TEST_CASE("orders are written with two decimals", "[report]") {
  CHECK(order_number(1) == "1.00");
  CHECK(order_number(-0.034) == "−0.03");
  CHECK(order_number(-1e-9) == "0.00");
}

TEST_CASE("powers of ten are written as such", "[report]") {
  CHECK(power_text(1e-3) == "10⁻³");
  CHECK(power_text(1e-12) == "10⁻¹²");
  CHECK(power_text(1) == "10⁰");
  CHECK(power_text(0.02) == "0.02");
}
