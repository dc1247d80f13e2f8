#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::report {

KindPage comparison_page() {
  KindPage page;
  page.scripts = scripts({"error_names", "order_dots", "errors"});
  page.tables = {"errors", "orders", "order_lines"};
  page.derived = {order_lines};
  page.answer = orders_html;
  return page;
}

namespace {

constexpr double line_factor = 2;  // within which a point follows the fitted line

/// An error of a case at x.
struct LinePoint {
  double x = 0, error = 0, floor = 0;
};

/// e = C x^p where the points follow it.
struct OrderLine {
  double from = 0, to = 0, constant = 0, power = 0;
  double at(double x) const { return constant * std::pow(x, power); }
};

/// The longest run of three or more points above their floor that stays within the factor of a line of this power.
std::optional<OrderLine> longest_line(const std::vector<LinePoint>& points, double power) {
  std::vector<LinePoint> above;
  for (const LinePoint& p : points)
    if (p.error > p.floor && p.error > 0) above.push_back(p);
  for (size_t count = above.size(); count >= 3; --count)
    for (size_t from = 0; from + count <= above.size(); ++from) {
      const auto first = above.begin() + static_cast<std::ptrdiff_t>(from),
                 last = first + static_cast<std::ptrdiff_t>(count);
      double mean = 0;
      for (auto p = first; p != last; ++p)
        mean += (std::log(p->error) - power * std::log(p->x)) / static_cast<double>(count);
      const OrderLine line{first->x, (last - 1)->x, std::exp(mean), power};
      if (std::all_of(first, last, [&](const LinePoint& p) {
            return std::abs(std::log(p.error / line.at(p.x))) <= std::log(line_factor);
          }))
        return line;
    }
  return std::nullopt;
}

/// All cases; for elements, those at the smallest step of their method: what the orders in elements are fitted to.
Cases cases_along(const Choices& choices, const std::string& refined) {
  if (refined == "step") return all_cases(choices.results());
  Cases out;
  const auto step = [](const CaseRecord* r) { return axis(*r, "step").number().value_or(HUGE_VAL); };
  for (const CaseGroup& group :
       choices.group(all_cases(choices.results()), choices.varying_without({"step", "elements"}))) {
    double smallest = HUGE_VAL;
    for (const CaseRecord* r : group.cases) smallest = std::min(smallest, step(r));
    for (const CaseRecord* r : group.cases)
      if (step(r) == smallest) out.push_back(r);
  }
  return out;
}

}  // namespace

Table order_lines(const Choices& choices) {
  const AxisRows<ErrorRow> errors(choices.results(), errors_type(),
                                  [](const ErrorRow& row) -> std::vector<std::string> { return {row.error}; });
  const AxisRows<OrderRow> orders(choices.results(), orders_type(),
                                  [](const OrderRow& row) -> std::vector<std::string> {
                                    return {row.refined, row.error};
                                  });
  Table out{"order_lines",
            "One row per line of a convergence figure: the longest run of points above their floor within a factor of "
            "two of e = C x^p.",
            {},
            {}};
  for (const Column& column : axis_columns(choices.results(), orders.axes())) out.columns.push_back(column);
  for (Column column : std::initializer_list<Column>{
           {"refined", "", "step or elements: what the line runs along."},
           {"error", "", "Name of the error."},
           {"order", "1", "The fitted power p."},
           {"from", "that of what is refined", "First abscissa of the line."},
           {"to", "that of what is refined", "Last abscissa of the line."},
           {"error_from", error_unit(choices.results()), "Height of the line at its first abscissa."},
           {"error_to", error_unit(choices.results()), "Height of the line at its last abscissa."}})
    out.columns.push_back(std::move(column));
  for (const std::string refined : {"step", "elements"}) {
    std::vector<std::string> method = choices.varying();
    std::erase(method, refined);
    if (refined == "elements") std::erase(method, "step");
    for (CaseGroup& group : choices.group(cases_along(choices, refined), method)) {
      std::stable_sort(group.cases.begin(), group.cases.end(), [&](const CaseRecord* a, const CaseRecord* b) {
        return axis(*a, refined).number().value_or(0) < axis(*b, refined).number().value_or(0);
      });
      for (const std::string& error : errors.values(&ErrorRow::error)) {
        std::optional<size_t> row;
        std::vector<LinePoint> points;
        for (const CaseRecord* record : group.cases) {
          if (!row) row = orders.find(*record, {refined, error}, {refined});
          const auto found = errors.find(*record, {error});
          const auto x = axis(*record, refined).number(), value = found ? errors[*found].value : x;
          if (found && x && value && record->status == Status::done)
            points.push_back({*x, *value, errors[*found].floor.value_or(0)});
        }
        const auto order = row ? orders[*row].order : std::nullopt;
        const auto line = order ? longest_line(points, refined == "step" ? *order : -*order) : std::nullopt;
        if (!line) continue;
        Row cells = orders.cells(*row);
        cells.insert(cells.end(),
                     {refined, error, *order, line->from, line->to, line->at(line->from), line->at(line->to)});
        out.rows.push_back(std::move(cells));
      }
    }
  }
  return out;
}

namespace {

std::string interval_text(const OrderRow& row) {
  return row.low && row.high ? fmt::format("[{}, {}]", order_number(*row.low), order_number(*row.high)) : "";
}

/// The looks of a verdict: those of a status.
const char* verdict_class(OrderVerdict verdict) {
  return verdict == OrderVerdict::refuted     ? "status failed"
         : verdict == OrderVerdict::undecided ? "status refused"
                                              : "status";
}

/// One order as "0.99 ✓": ✓ confirmed, ✕ refuted, ? undecided, none where nothing is declared.
void order_cell(HtmlTable& table, const OrderRow& row) {
  const char *verdict = word(row.verdict), *looks = row.declared ? verdict_class(row.verdict) : "status";
  const std::string floor = row.saturates_at.value_or("");
  if (!floor.empty()) {
    table.number(floor == "not told" ? "does not fall" : "floor: " + floor, fmt::format("{}: {}", verdict, row.reason),
                 looks);
    return;
  }
  const char* mark = !row.declared                            ? ""
                     : row.verdict == OrderVerdict::confirmed ? " ✓"
                     : row.verdict == OrderVerdict::refuted   ? " ✕"
                                                              : " ?";
  table.number((row.order ? order_number(*row.order) : "–") + mark,
               fmt::format("{}{}{}: {}", interval_text(row), row.order ? " " : "", verdict, row.reason), looks);
}

/// What a row is about, without the kind of error.
struct Method {
  std::string label, colour, key, refined;
  std::vector<const OrderRow*> rows;
};

std::vector<Method> methods(const Choices& choices, const AxisRows<OrderRow>& rows) {
  std::vector<Method> out;
  for (size_t row = 0; row < rows.size(); ++row) {
    // What the row does not say (the element count of a refinement of elements) is not said.
    std::vector<std::string> columns;
    std::string key = rows[row].refined;
    for (size_t axis = 0; axis < rows.axes().size(); ++axis) {
      const std::string value = rows.axis_text(row, axis);
      if (!value.empty()) columns.push_back(rows.axes()[axis]);
      key += '\x1f' + value;
    }
    auto found = std::find_if(out.begin(), out.end(), [&](const Method& m) { return m.key == key; });
    if (found == out.end()) {
      const CaseRecord* example = rows.example(row, choices.results());
      found = out.insert(out.end(), {example ? choices.short_name(*example, columns) : "the one method",
                                     example ? choices.colour(*example) : "",
                                     key,
                                     rows[row].refined,
                                     {}});
    }
    found->rows.push_back(&rows[row]);
  }
  return out;
}

/// The orders that a method declares over its errors: "1", "1, 2".
std::string declared_text(const Method& method) {
  std::vector<std::string> said;
  for (const OrderRow* row : method.rows)
    if (row->declared) {
      std::string text = number_text(*row->declared, 3);
      if (std::find(said.begin(), said.end(), text) == said.end()) said.push_back(std::move(text));
    }
  return said.empty() ? "–" : fmt::format("{}", fmt::join(said, ", "));
}

/// Methods × errors.
std::string matrix(const std::vector<std::string>& errors, const std::vector<Method>& all) {
  HtmlTable table(
      "Order p of e ≈ C r<sup>p</sup>, r the step or the length of an element, fitted over the range that behaves so. "
      "✓ confirms the declared order, ✕ refutes it, ? does not decide; the tooltip has the 95 % interval and the "
      "reason.",
      {{"method"}, {"refined"}, {"declared", true}});
  for (const std::string& error : errors) table.add({error, true});
  for (const Method& method : all) {
    table.row(method.label, method.colour).text(method.refined).number(declared_text(method));
    for (const std::string& error : errors) {
      const auto found = std::find_if(method.rows.begin(), method.rows.end(),
                                      [&](const OrderRow* row) { return row->error == error; });
      if (found == method.rows.end())
        table.absent();
      else
        order_cell(table, **found);
    }
  }
  return table.html();
}

/// Every order with its interval and reason, what is not confirmed first.
std::string details(const std::vector<Method>& all) {
  HtmlTable table("",
                  {{"method"}, {"refined"}, {"error"}, {"order", true}, {"declared", true}, {"verdict"}, {"reason"}});
  for (const OrderVerdict wanted : {OrderVerdict::refuted, OrderVerdict::undecided, OrderVerdict::confirmed})
    for (const Method& method : all)
      for (const OrderRow* row : method.rows) {
        if (row->verdict != wanted) continue;
        table.row(method.label, method.colour).text(method.refined).text(row->error, "text");
        const std::string floor = row->saturates_at.value_or("");
        table.number(floor.empty() ? (row->order ? order_number(*row->order) : "–") + " " + interval_text(*row)
                                   : "floor: " + floor);
        table.number(row->declared ? number_text(*row->declared, 3) : "–");
        table.text(word(row->verdict), verdict_class(row->verdict)).text(row->reason, "reason");
      }
  return "<details><summary>Every order with its interval, verdict and reason</summary>\n" + table.html() +
         "</details>\n";
}

/// "24 orders against what the methods declare: 18 confirmed, 2 refuted, 4 undecided."
std::string counts(const StudyResults& results) {
  const std::vector<OrderVerdicts> rows = order_verdicts_type().read(results.derived);
  if (rows.empty()) return "";
  const OrderVerdicts& all = rows.front();
  std::string out;
  for (const auto& [count, verdict] : {std::pair(all.confirmed, OrderVerdict::confirmed),
                                       {all.refuted, OrderVerdict::refuted},
                                       {all.undecided, OrderVerdict::undecided}})
    if (count > 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, word(verdict));
  if (all.declared == 0)
    return fmt::format("<p class=\"lead\">{}, none with a declared order to compare with.</p>\n",
                       count_text(all.orders, "order", "orders"));
  return fmt::format("<p class=\"lead\">{} against what the methods declare: {}.</p>\n",
                     count_text(all.declared, "order", "orders"), out);
}

}  // namespace

std::string orders_html(const Choices& choices) {
  const AxisRows<OrderRow> rows(choices.results(), orders_type());
  if (rows.empty()) return "";
  const std::vector<Method> all = methods(choices, rows);
  return counts(choices.results()) + matrix(rows.values(&OrderRow::error), all) + details(all);
}

}  // namespace ricochet::report
