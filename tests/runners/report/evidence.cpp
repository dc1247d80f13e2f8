// The report's evidence: what is told is what the derived tables hold.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/work-precision/page/page.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/kind_page.hpp"
#include "runners/report/quantity.hpp"
#include "tests/runners/report/evidence_results.hpp"

using namespace ricochet;
using namespace ricochet::report;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const Table& table(const StudyResults& results, const std::string& name) {
  return *std::find_if(results.derived.begin(), results.derived.end(), [&](const auto& t) { return t.name == name; });
}

}  // namespace

TEST_CASE("without derived tables there is no evidence", "[report]") {
  const StudyResults results = synthetic::results();
  const Choices choices(results);
  CHECK(page_tables(Choices(results), work_precision_page()).empty());
  CHECK(orders_html(choices).empty());
  CHECK(work_precision_html(choices).empty());
  CHECK(effects_html(choices).empty());
}

TEST_CASE("rows are found by the axes of a case", "[report]") {
  const StudyResults results = synthetic::comparison({1e-3, 5e-4}, {10, 20});
  const AxisRows<ErrorRow> errors(results, errors_type(),
                                  [](const ErrorRow& row) { return std::vector<std::string>{row.error}; });
  const AxisRows<OrderRow> orders(results, orders_type(), [](const OrderRow& row) {
    return std::vector<std::string>{row.refined, row.error};
  });
  for (const CaseRecord& record : results.cases) {
    const auto row = errors.find(record, {"energy"});
    CHECK(row.has_value() == ricochet::measure(record, "error.energy").has_value());
    if (row) CHECK(errors[*row].value == ricochet::measure(record, "error.energy"));
    CHECK_FALSE(errors.find(record, {"no such"}));
    const auto order = orders.find(record, {"elements", "energy"}, {"elements"});
    for (size_t axis = 0; order && axis < orders.axes().size(); ++axis)
      if (orders.axes()[axis] == "elements") CHECK(orders.axis_text(*order, axis).empty());
    CHECK(order.has_value() == (record.status != Status::refused));
  }
  CHECK(AxisRows<ErrorRow>(StudyResults{}, errors_type()).empty());
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

TEST_CASE("the cheapest method is the one that a search over all cases finds", "[report]") {
  const StudyResults results = synthetic::comparison();
  const Choices choices(results);
  const std::string html = work_precision_html(choices);
  const WorkPrecision work(choices);
  for (const std::string& error : work.errors()) {
    const auto points = work.points(all_cases(choices.results()), error);
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
                              choices.short_label(*best->record, choices.varying_without({"step"})) + "</td>";
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
  const Choices choices(results);
  const std::string html = orders_html(choices);
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
  CHECK(contains(orders_html(Choices(none)), "none with a declared order"));
}

TEST_CASE("effects are sentences and bars", "[report]") {
  const StudyResults results = synthetic::comparison();
  const Choices choices(results);
  const std::string html = effects_html(choices);
  CHECK(contains(html,
                 "81 % of the spread of error.tip-linf (on a logarithmic scale) comes from the step, 9 % from the mass "
                 "matrix, 5.5 % from its interaction with the mass matrix."));
  CHECK(contains(
      html,
      "86 % of the spread of energy end comes from the mass matrix, 8 % from its interaction with the step, 2.5 % "
      "from the time scheme."));
  CHECK(contains(html, "7 of 36 cases have no value (6 refused, 1 diverged); what they would be is estimated"));
  CHECK(contains(html, "One level only, so no share: contact."));
}

TEST_CASE("a measure without shares says so", "[report]") {
  StudyResults results = synthetic::comparison();
  for (Table& t : results.derived)
    if (t.name == "effects")
      for (auto& row : t.rows) row[2] = row[3] = row[4] = 0.0;
  CHECK(contains(effects_html(Choices(results)), "No shares for energy end."));
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
