#include <algorithm>
#include <cmath>
#include <optional>

#include "runners/kinds/comparison/page/page.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::report {
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
Cases cases_along(const CaseView& view, const std::string& refined) {
  if (refined == "step") return view.all();
  Cases out;
  const auto step = [](const CaseRecord* r) { return CaseView::number(*r, "step").value_or(HUGE_VAL); };
  for (const CaseGroup& group : view.group(view.all(), view.varying_without({"step", "elements"}))) {
    double smallest = HUGE_VAL;
    for (const CaseRecord* r : group.cases) smallest = std::min(smallest, step(r));
    for (const CaseRecord* r : group.cases)
      if (step(r) == smallest) out.push_back(r);
  }
  return out;
}

}  // namespace

Table order_lines(const CaseView& view) {
  const AxisRows errors(view.results(), "errors", {"error"}), orders(view.results(), "orders", {"refined", "error"});
  Table out{"order_lines",
            "One row per line of a convergence figure: the longest run of points above their floor within a factor of "
            "two of e = C x^p.",
            {},
            {}};
  for (const Column& column : axis_columns(view.results(), orders.axes())) out.columns.push_back(column);
  for (Column column :
       std::initializer_list<Column>{{"refined", "", "step or elements: what the line runs along."},
                                     {"error", "", "Name of the error."},
                                     {"order", "1", "The fitted power p."},
                                     {"from", "that of what is refined", "First abscissa of the line."},
                                     {"to", "that of what is refined", "Last abscissa of the line."},
                                     {"error_from", "that of the error", "Height of the line at its first abscissa."},
                                     {"error_to", "that of the error", "Height of the line at its last abscissa."}})
    out.columns.push_back(std::move(column));
  for (const std::string refined : {"step", "elements"}) {
    std::vector<std::string> method = view.varying();
    std::erase(method, refined);
    if (refined == "elements") std::erase(method, "step");
    for (CaseGroup& group : view.group(cases_along(view, refined), method)) {
      std::stable_sort(group.cases.begin(), group.cases.end(), [&](const CaseRecord* a, const CaseRecord* b) {
        return CaseView::number(*a, refined).value_or(0) < CaseView::number(*b, refined).value_or(0);
      });
      for (const std::string& error : errors.values("error")) {
        std::optional<size_t> row;
        std::vector<LinePoint> points;
        for (const CaseRecord* record : group.cases) {
          if (!row) row = orders.find(*record, {refined, error}, {refined});
          const auto found = errors.find(*record, {error});
          const auto x = CaseView::number(*record, refined), value = found ? errors.number(*found, "value") : x;
          if (found && x && value && record->status == "done")
            points.push_back({*x, *value, errors.number(*found, "floor").value_or(0)});
        }
        const auto order = row ? orders.number(*row, "order") : std::nullopt;
        const auto line = order ? longest_line(points, refined == "step" ? *order : -*order) : std::nullopt;
        if (!line) continue;
        Row cells;
        for (const std::string& column : orders.axes()) cells.push_back(orders.value(*row, column));
        cells.insert(cells.end(),
                     {refined, error, *order, line->from, line->to, line->at(line->from), line->at(line->to)});
        out.rows.push_back(std::move(cells));
      }
    }
  }
  return out;
}

}  // namespace ricochet::report
