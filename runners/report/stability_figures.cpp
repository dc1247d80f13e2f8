#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/report/method_curves.hpp"
#include "runners/report/options.hpp"
#include "runners/report/stability_map.hpp"
#include "runners/report/stability_report.hpp"
#include "runners/report/stability_rows.hpp"

namespace ricochet::report {
namespace {

/// What stands on the vertical axis: the radius, or its excess over one.
struct Height {
  Quantity quantity;
  bool growth = false;
  std::optional<double> of(const StabilityCell& cell) const {
    if (!cell.radius) return std::nullopt;
    const double value = growth ? *cell.radius - 1 : *cell.radius;
    // Below 1e-9 a radius is one to round-off; 1e-6 is what counts as growth.
    return value > (growth ? 1e-9 : 0.0) ? std::optional(value) : std::nullopt;
  }
};

class RadiusFigure {
 public:
  explicit RadiusFigure(const CaseView& view) : view_(view) {
    for (const bool closed : {false, true})
      for (const CaseRecord* record : stability_cases(view, closed)) {
        const StabilityRange range = *stability_range(*record, closed);
        for (const StabilityCell& cell : range.cells) steps_.include(cell.step);
      }
  }

  std::optional<Figure> make() const {
    if (steps_.empty()) return std::nullopt;
    Figure figure{
        "spectral-radius", "Spectral radius of one step", "", {"spectral radius", "growth per step"}, {}, {}, false};
    const Height heights[] = {{{"spectral radius", "1"}, false}, {{"growth per step", "1"}, true}};
    for (const bool closed : {false, true}) {
      const Cases cases = stability_cases(view_, closed);
      if (cases.empty()) continue;
      const MethodCurves curves(view_, cases, "step", {}, closed ? std::vector<std::string>{} : contact_columns(view_));
      for (const LegendEntry& entry : curves.legend())
        if (std::none_of(figure.legend.begin(), figure.legend.end(),
                         [&](const LegendEntry& e) { return e.name == entry.name; }))
          figure.legend.push_back(entry);
      figure.caption = curves.colours_text() +
                       " Closed: the worst of several sets of points held on both sides. Hollow: marginal roots. ✕: "
                       "observed unstable where the spectrum is not.";
      Interval range[2] = {Interval::nothing(), Interval::nothing()};
      for (const CaseRecord* record : cases) {
        const StabilityRange along = *stability_range(*record, closed);
        for (const StabilityCell& cell : along.cells)
          for (int k = 0; k < 2; ++k)
            if (const auto y = heights[k].of(cell)) range[k].include(*y);
      }
      for (const MethodFacet& facet : curves.facets()) {
        Chart chart;
        chart.title = (closed ? "closed" : "open") + (facet.title == "all cases" ? "" : " · " + facet.title);
        for (int k = 0; k < 2; ++k) chart.views.push_back(chart_view(heights[k], facet, closed, range[k]));
        chart.notes = outcome_notes(view_, facet.cases, curves.said());
        figure.charts.push_back(std::move(chart));
      }
    }
    return figure;
  }

 private:
  ChartView chart_view(const Height& height, const MethodFacet& facet, bool closed, Interval range) const {
    ChartView out;
    out.x = {"step h", "s"};
    out.y = height.quantity;
    if (range.empty()) {
      range = height.growth ? Interval{1e-9, 1e-6} : Interval{0.1, 10};
      out.notes.push_back(height.growth ? "Nothing grows." : "Nothing is predicted.");
    }
    const Interval decades = whole_decades(range);
    if (!height.growth) range = {std::min(decades.low, 0.1), std::max(decades.high, 10.0)};
    const Json gutter = {{"type", "value"}, {"min", 0}, {"max", 1}, {"show", false}};
    out.option =
        base_option(log_axis(out.x, steps_, false), Json::array({log_axis(out.y, range, true), gutter}), false, true);
    if (!height.growth) out.option["series"].push_back(circle_line(out.option["xAxis"]));
    std::string flat;
    for (const MethodCurve& curve : facet.curves) {
      for (const CaseRecord* record : curve.cases) {
        const auto cells = stability_range(*record, closed);
        if (!cells) continue;
        Json data = Json::array(), marks = Json::array();
        bool drawn = false;
        for (const StabilityCell& cell : cells->cells) {
          const auto y = height.of(cell);
          if (cell.disagrees() && cell.observed_unstable())
            marks.push_back({{"value", {cell.step, 0.95}}, {"mark", "✕"}, {"text", cell.reason}});
          if (!y) {
            data.push_back({{"value", {cell.step, "-"}}});
            continue;
          }
          drawn = true;
          Json item = {{"value", {cell.step, *y}}, {"text", point_text(cell)}};
          if (!cell.marginal.empty())
            item["itemStyle"] = {{"color", "#ffffff"}, {"borderColor", curve.colour}, {"borderWidth", 1.6}};
          data.push_back(std::move(item));
        }
        if (!drawn && height.growth) flat += (flat.empty() ? "" : "; ") + curve.name;
        out.option["series"].push_back(
            {{"type", "line"},
             {"name", curve.name},
             {"symbol", symbol(curve.style)},
             {"symbolSize", 7},
             {"color", curve.colour},
             {"itemStyle", {{"color", curve.colour}}},
             {"lineStyle", {{"color", curve.colour}, {"width", 1.4}, {"type", line_dash(curve.style)}}},
             {"data", std::move(data)}});
        if (marks.empty()) continue;
        Json series = mark_series(curve.name, curve.colour, std::move(marks));
        series["yAxisIndex"] = 1;
        out.option["series"].push_back(std::move(series));
      }
    }
    if (!flat.empty()) out.notes.push_back("No growth at any step: " + flat + ".");
    return out;
  }

  static std::string point_text(const StabilityCell& cell) {
    std::string out = fmt::format("radius {}", number_text(*cell.radius, 9));
    if (!cell.marginal.empty()) out += "; " + cell.marginal;
    if (!cell.reason.empty()) out += "; " + cell.reason;
    return out;
  }

  /// |r| = 1.
  static Json circle_line(const Json& x) {
    Json data = Json::array();
    for (const char* end : {"min", "max"}) data.push_back({{"value", {x[end], 1}}});
    return {{"type", "line"},
            {"name", "unit circle"},
            {"symbol", "none"},
            {"silent", true},
            {"z", 1},
            {"color", "#9a9a9a"},
            {"lineStyle", {{"color", "#9a9a9a"}, {"width", 1}, {"type", "solid"}}},
            {"data", std::move(data)}};
  }

  const CaseView& view_;
  Interval steps_ = Interval::nothing();
};

}  // namespace

std::vector<Figure> stability_figures(const CaseView& view) {
  std::vector<Figure> out;
  if (auto figure = RadiusFigure(view).make()) out.push_back(std::move(*figure));
  for (Figure& figure : stability_maps(view)) out.push_back(std::move(figure));
  return out;
}

}  // namespace ricochet::report
