#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/report/evidence.hpp"
#include "runners/report/evidence_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/method_curves.hpp"
#include "runners/report/options.hpp"

namespace ricochet::report {
namespace {

constexpr double follows = 2;          // factor within which a point follows the fitted line
constexpr double mark_height = 0.085;  // of the frame
constexpr const char* grey = "#b3b3b3";
constexpr const char* floor_name = "error floor";
constexpr const char* floor_colour = "#7a7a7a";

/// An error of a case, drawn at x.
struct Point {
  double x = 0, error = 0, floor = 0;
};

/// e = C x^p where the points follow it.
struct Slope {
  double from = 0, to = 0, constant = 0, power = 0;
  double at(double x) const { return constant * std::pow(x, power); }
};

/// The longest run of three or more points above their floor that stays within a factor of `follows` of a line of this
/// power.
std::optional<Slope> slope_line(const std::vector<Point>& points, double power) {
  std::vector<Point> above;
  for (const Point& p : points)
    if (p.error > p.floor && p.error > 0) above.push_back(p);
  for (size_t count = above.size(); count >= 3; --count)
    for (size_t from = 0; from + count <= above.size(); ++from) {
      double mean = 0;
      for (size_t k = from; k < from + count; ++k)
        mean += (std::log(above[k].error) - power * std::log(above[k].x)) / static_cast<double>(count);
      const Slope line{above[from].x, above[from + count - 1].x, std::exp(mean), power};
      if (std::all_of(above.begin() + static_cast<std::ptrdiff_t>(from),
                      above.begin() + static_cast<std::ptrdiff_t>(from + count),
                      [&](const Point& p) { return std::abs(std::log(p.error / line.at(p.x))) <= std::log(follows); }))
        return line;
    }
  return std::nullopt;
}

class ErrorFigure {
 public:
  ErrorFigure(const CaseView& view, std::string refined)
      : view_(view),
        refined_(std::move(refined)),
        errors_(view.results(), "errors", {"error"}),
        orders_(view.results(), "orders", {"refined", "error"}),
        curves_(view, cases(), refined_, {}, by_step() ? std::vector<std::string>{} : std::vector<std::string>{"step"}),
        x_(by_step() ? Quantity{"step h", "s"} : Quantity{"elements", "1"}) {
    for (const MethodFacet& facet : curves_.facets())
      for (const CaseRecord* record : facet.cases)
        if (const auto x = CaseView::number(*record, refined_)) x_range_.include(*x);
    for (const MethodFacet& facet : curves_.facets()) {
      std::map<double, double> marks;
      for (const CaseRecord* record : facet.cases)
        if (record->status != "done")
          gutter_ = std::max(gutter_, ++marks[CaseView::number(*record, refined_).value_or(x_range_.low)]);
    }
    gutter_ = gutter_ > 0 ? std::min(0.5, 0.05 + mark_height * gutter_) : 0;
  }

  std::optional<Figure> make() const {
    Figure figure{"error-" + refined_,
                  by_step() ? "Errors against the step" : "Errors against the number of elements",
                  curves_.colours_text() +
                      fmt::format(" The pale band under a curve is its fitted order, drawn over the points that stay "
                                  "within a factor of {:g} of it; the number at its end is the order. Grey points are "
                                  "at or below the error floor, which is how far apart two references are.",
                                  follows) +
                      (by_step() ? "" : " Each method at its smallest step."),
                  {},
                  {},
                  curves_.legend(),
                  false};
    for (const MethodFacet& facet : curves_.facets())
      figure.charts.push_back({facet.title, {}, outcome_notes(view_, facet.cases, curves_.said())});
    bool floors = false;
    for (const std::string& error : errors_.values("error")) {
      const Interval range = y_range(error);
      if (range.empty()) continue;
      figure.views.push_back(error);
      for (size_t f = 0; f < figure.charts.size(); ++f)
        figure.charts[f].views.push_back(chart_view(error, curves_.facets()[f], range, floors));
    }
    if (figure.views.empty()) return std::nullopt;
    if (floors) figure.legend.push_back({floor_name, floor_colour, svg_dash(2), ""});
    return figure;
  }

 private:
  bool by_step() const { return refined_ == "step"; }

  /// All cases; for elements, those at the smallest step of their method.
  Cases cases() const {
    if (by_step()) return view_.all();
    std::vector<std::string> method = view_.varying_without({"step", "elements"});
    Cases out;
    for (const CaseGroup& group : view_.group(view_.all(), method)) {
      double smallest = HUGE_VAL;
      for (const CaseRecord* r : group.cases)
        smallest = std::min(smallest, CaseView::number(*r, "step").value_or(HUGE_VAL));
      for (const CaseRecord* r : group.cases)
        if (CaseView::number(*r, "step").value_or(HUGE_VAL) == smallest) out.push_back(r);
    }
    return out;
  }

  std::optional<Point> point(const CaseRecord& record, const std::string& error) const {
    const auto row = errors_.find(record, {error});
    const auto x = CaseView::number(record, refined_), value = row ? errors_.number(*row, "value") : std::nullopt;
    if (!x || !value) return std::nullopt;
    return Point{*x, *value, errors_.number(*row, "floor").value_or(0)};
  }

  Interval y_range(const std::string& error) const {
    Interval out = Interval::nothing(), floors = Interval::nothing();
    for (const MethodFacet& facet : curves_.facets())
      for (const CaseRecord* record : facet.cases)
        if (const auto p = point(*record, error)) {
          if (p->error > 0) out.include(p->error);
          if (p->floor > 0) floors.include(p->floor);
        }
    // A floor far below everything stays out of sight.
    if (!out.empty() && !floors.empty() && floors.high >= 1e-2 * out.low) out.include(std::min(floors.high, out.high));
    return out;
  }

  std::string order_text(std::optional<size_t> row) const {
    if (!row) return "";
    const auto order = orders_.number(*row, "order"), low = orders_.number(*row, "low"),
               high = orders_.number(*row, "high");
    std::string out = order && low && high ? fmt::format("order {} [{}, {}], ", order_number(*order),
                                                         order_number(*low), order_number(*high))
                                           : "no order, ";
    return out + orders_.text(*row, "verdict");
  }

  ChartView chart_view(const std::string& error, const MethodFacet& facet, const Interval& range, bool& floors) const {
    ChartView out;
    out.x = x_;
    out.y = error_quantity(error);
    Json x = log_axis(x_, x_range_, false), y = log_axis(out.y, range, true);
    const double lowest = y["min"].get<double>(), highest = y["max"].get<double>();
    y["max"] = highest * std::pow(highest / lowest, gutter_ / (1 - gutter_));
    const Json gutter = {{"type", "value"}, {"min", 0}, {"max", 1}, {"show", false}};
    out.option = base_option(std::move(x), Json::array({std::move(y), gutter}), false, true);
    out.option["grid"]["right"] = 46;
    std::map<double, double> floor_at;
    std::map<double, int> stacked;
    std::string zeros;
    size_t without = 0;
    for (const MethodCurve& curve : facet.curves) {
      std::optional<size_t> order;
      for (const CaseRecord* record : curve.cases)
        if (!order) order = orders_.find(*record, {refined_, error}, {refined_});
      const std::string said = order_text(order);
      std::vector<Point> points;
      Json data = Json::array(), marks = Json::array();
      for (const CaseRecord* record : curve.cases) {
        const double at = CaseView::number(*record, refined_).value_or(x_range_.low);
        const auto p = point(*record, error);
        if (record->status != "done") {
          marks.push_back({{"value", {at, 0.95 - mark_height * stacked[at]++}},
                           {"mark", status_mark(record->status)},
                           {"text", record->status + ": " + record->reason}});
          continue;
        }
        if (!p) {
          ++without;
          continue;
        }
        if (p->floor > 0) floor_at[at] = std::max(floor_at[at], p->floor);
        points.push_back(*p);
        if (!(p->error > 0)) {
          zeros += (zeros.empty() ? "" : ", ") + curve.name + " at " + exact_text(at);
          continue;
        }
        Json item = {{"value", {at, p->error}}, {"text", point_text(*p, out.y, said)}};
        if (p->error <= p->floor) item["itemStyle"] = {{"color", grey}};
        data.push_back(std::move(item));
      }
      const auto slope = order ? orders_.number(*order, "order") : std::nullopt;
      if (const auto line = slope ? slope_line(points, by_step() ? *slope : -*slope) : std::nullopt)
        out.option["series"].push_back(slope_series(curve, *line, *slope, said));
      out.option["series"].push_back(
          {{"type", "line"},
           {"name", curve.name},
           {"symbol", symbol(curve.style)},
           {"symbolSize", 8},
           {"color", curve.colour},
           {"itemStyle", {{"color", curve.colour}}},
           {"lineStyle", {{"color", curve.colour}, {"width", 1.6}, {"type", line_dash(curve.style)}}},
           {"data", std::move(data)}});
      if (!marks.empty()) {
        Json series = mark_series(curve.name, curve.colour, std::move(marks));
        series["yAxisIndex"] = 1;
        out.option["series"].push_back(std::move(series));
      }
    }
    Json floor = Json::array();
    for (const auto& [at, height] : floor_at)
      if (height >= lowest) floor.push_back({{"value", {at, height}}, {"text", number_text(height, 3)}});
    if (!floor.empty()) {
      floors = true;
      out.option["series"].push_back({{"type", "line"},
                                      {"name", floor_name},
                                      {"symbol", floor.size() == 1 ? "rect" : "none"},
                                      {"symbolSize", {24, 1.5}},
                                      {"z", 1},
                                      {"color", floor_colour},
                                      {"lineStyle", {{"color", floor_colour}, {"width", 1.2}, {"type", line_dash(2)}}},
                                      {"areaStyle", {{"color", "#000000"}, {"opacity", 0.05}, {"origin", "start"}}},
                                      {"data", std::move(floor)}});
    } else if (!floor_at.empty()) {
      out.notes.push_back("The error floor is below this frame.");
    }
    if (!zeros.empty()) out.notes.push_back("Exactly 0, which a logarithmic axis cannot show: " + zeros + ".");
    if (without)
      out.notes.push_back(count_text(without, "finished case has", "finished cases have") +
                          " no such error: the notes say why.");
    return out;
  }

  static std::string point_text(const Point& p, const Quantity& quantity, const std::string& order) {
    std::string out = number_text(p.error, 5) + (quantity.unit == "1" ? "" : " " + quantity.unit);
    if (p.floor > 0) out += (p.error <= p.floor ? ", at or below the floor of " : ", floor ") + number_text(p.floor, 3);
    return out + (order.empty() ? "" : "; " + order);
  }

  static Json slope_series(const MethodCurve& curve, const Slope& line, double order, const std::string& said) {
    return {{"type", "line"},
            {"name", curve.name},
            {"symbol", "none"},
            {"z", 1},
            {"color", curve.colour},
            {"lineStyle", {{"color", lighten(curve.colour, 0.72)}, {"width", 7}, {"cap", "round"}}},
            {"endLabel",
             {{"show", true},
              {"formatter", order_number(order)},
              {"color", curve.colour},
              {"fontSize", 11},
              {"distance", 8}}},
            {"labelLayout", {{"moveOverlap", "shiftY"}}},
            {"data",
             {{{"value", {line.from, line.at(line.from)}}, {"text", said}},
              {{"value", {line.to, line.at(line.to)}}, {"text", said}}}}};
  }

  const CaseView& view_;
  std::string refined_;
  EvidenceRows errors_, orders_;
  MethodCurves curves_;
  Quantity x_;
  Interval x_range_ = Interval::nothing();
  double gutter_ = 0;  ///< share of the frame's height that marks of cases without an error take
};

}  // namespace

std::vector<Figure> error_figures(const CaseView& view) {
  std::vector<Figure> out;
  if (EvidenceRows(view.results(), "errors").empty()) return out;
  for (const char* refined : {"step", "elements"})
    if (view.varies(refined))
      if (auto figure = ErrorFigure(view, refined).make()) out.push_back(std::move(*figure));
  return out;
}

}  // namespace ricochet::report
