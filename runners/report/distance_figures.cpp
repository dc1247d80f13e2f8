#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/report/dynamics_report.hpp"
#include "runners/report/evidence_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/method_curves.hpp"
#include "runners/report/options.hpp"
#include "runners/report/orbits.hpp"

namespace ricochet::report {
namespace {

constexpr const char* null_colour = "#B9C7D6";
constexpr const char* null_name = "null level";

struct Kind {
  const char *view, *column, *null;
};
constexpr Kind kinds[] = {{"Wasserstein-1", "wasserstein", "null_wasserstein"},
                          {"Hausdorff", "hausdorff", "null_hausdorff"}};

/// The value below which a share of the sorted numbers lies.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<size_t>(at);
  const size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

struct Spread {
  double low = 0, middle = 0, high = 0;
  size_t zeros = 0, count = 0;
};

/// What the middle 80 % of some distances reach.
std::optional<Spread> spread_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const auto zeros = static_cast<size_t>(std::count(values.begin(), values.end(), 0.0));
  return Spread{quantile(values, 0.1), quantile(values, 0.5), quantile(values, 0.9), zeros, values.size()};
}

/// One row of the table `distances`.
struct Distance {
  double parameter = 0;
  std::optional<double> value[2], null[2];
};

class Distances {
 public:
  explicit Distances(const CaseView& view) : view_(view), parameter_(swept_parameter(view.results())) {
    const EvidenceRows rows(view.results(), "distances");
    for (size_t row = 0; row < rows.size(); ++row) {
      const auto parameter = rows.number(row, "parameter");
      if (!parameter) continue;
      Distance distance;
      distance.parameter = *parameter;
      for (int k = 0; k < 2; ++k) {
        distance.value[k] = rows.number(row, kinds[k].column);
        distance.null[k] = rows.number(row, kinds[k].null);
        if (distance.null[k]) nulls_[k].push_back(*distance.null[k]);
        for (const auto& one : {distance.value[k], distance.null[k]})
          if (one && *one > 0) range_[k].include(*one);
      }
      parameters_.include(*parameter);
      reference_ = rows.text(row, "reference_case");
      by_case_[rows.text(row, "case")].push_back(distance);
    }
    for (const CaseRecord* record : view.all())
      if (by_case_.contains(record->id) && record->id != reference_) cases_.push_back(record);
  }

  bool empty() const { return cases_.empty() || (range_[0].empty() && range_[1].empty()); }

  std::vector<Figure> make() const {
    std::vector<Figure> out;
    for (const std::string& column : view_.varying()) {
      std::set<double> values;
      for (const CaseRecord* record : cases_)
        if (const auto value = CaseView::number(*record, column)) values.insert(*value);
      if (values.size() >= 3) out.push_back(against(column, {*values.begin(), *values.rbegin()}));
    }
    out.push_back(along());
    return out;
  }

 private:
  std::string reference_text() const {
    for (const CaseRecord* record : view_.all())
      if (record->id == reference_) {
        const std::string label = view_.label(*record);
        return label.empty() ? "the one method" : label;
      }
    return reference_;
  }

  Figure figure(const std::string& id, const std::string& title, const std::string& caption) const {
    Figure out{id, title, caption, {}, {}, {}, false};
    for (const Kind& kind : kinds) out.views.push_back(kind.view);
    out.caption += fmt::format(
        " Reference: {}. Distances of sections in (displacement, velocity), each divided by its spread over "
        "the study. Band: up to the null level, what two halves of one run differ by.",
        reference_text());
    return out;
  }

  static Quantity quantity(int k) { return {std::string(kinds[k].view) + " distance", "1"}; }

  /// Medians by case against a numeric axis.
  Figure against(const std::string& column, const Interval& values) const {
    std::string slug = column;
    std::replace(slug.begin(), slug.end(), '.', '-');
    Figure out = figure("distance-" + slug, "Distance to the reference against " + column,
                        "Median over parameter and starts; bars: the middle 80 % of them.");
    Cases cases;
    for (const CaseRecord* record : cases_)
      if (CaseView::number(*record, column)) cases.push_back(record);
    const MethodCurves curves(view_, cases, column, {}, {});
    out.legend = curves.legend();
    out.legend.push_back({null_name, null_colour, "0 30", "rect"});
    out.caption += " " + curves.colours_text();
    for (const MethodFacet& facet : curves.facets()) {
      Chart chart;
      chart.title = facet.title;
      for (int k = 0; k < 2; ++k) chart.views.push_back(against_view(column, values, facet, k));
      out.charts.push_back(std::move(chart));
    }
    return out;
  }

  ChartView against_view(const std::string& column, const Interval& values, const MethodFacet& facet, int k) const {
    ChartView out;
    const std::string unit = axis_unit(column);
    out.x = {column, unit};
    out.y = quantity(k);
    Interval heights = Interval::nothing();
    Json series = Json::array();
    const auto null = spread_of(nulls_[k]);
    size_t zeros = 0, shown = 0;
    for (const MethodCurve& curve : facet.curves) {
      Json data = Json::array(), bars = Json::array();
      for (const CaseRecord* record : curve.cases) {
        const auto spread = spread_of(values_of(record->id, k));
        const double x = CaseView::number(*record, column).value_or(0);
        if (!spread) continue;
        ++shown;
        if (!(spread->middle > 0)) {
          ++zeros;
          data.push_back({{"value", {x, "-"}}});
          continue;
        }
        heights.include(spread->middle);
        if (spread->high > 0) heights.include(spread->high);
        const double low = spread->low > 0 ? spread->low : spread->middle;
        heights.include(low);
        data.push_back({{"value", {x, spread->middle}},
                        {"text", fmt::format("median {} over {}; 10 % to 90 %: {} to {}; {} are exactly zero",
                                             number_text(spread->middle), count_text(spread->count, "value", "values"),
                                             number_text(spread->low), number_text(spread->high), spread->zeros)}});
        for (const Json& end : {Json(low), Json(spread->high), Json("-")}) bars.push_back({x, end});
      }
      series.push_back({{"type", "line"},
                        {"name", curve.name},
                        {"symbol", symbol(curve.style)},
                        {"symbolSize", 7},
                        {"z", 3},
                        {"color", curve.colour},
                        {"itemStyle", {{"color", curve.colour}}},
                        {"lineStyle", {{"color", curve.colour}, {"width", 1.6}, {"type", line_dash(curve.style)}}},
                        {"data", std::move(data)}});
      series.push_back({{"type", "line"},
                        {"name", curve.name},
                        {"symbol", "none"},
                        {"silent", true},
                        {"z", 2},
                        {"color", curve.colour},
                        {"lineStyle", {{"color", lighten(curve.colour, 0.4)}, {"width", 1.2}}},
                        {"data", std::move(bars)}});
    }
    if (null && null->high > 0) heights.include(null->high);
    if (null && null->middle > 0) heights.include(0.5 * null->middle);
    if (heights.empty()) heights = {0.1, 1};
    const bool logarithmic = values.low > 0 && values.high >= 9 * values.low;
    const Json x = logarithmic ? log_axis(out.x, values, false) : value_axis(out.x, padded(values), false);
    out.option = base_option(x, log_axis(out.y, heights, true), false, true);
    const Interval frame = whole_decades(heights);
    if (null && null->high > 0) out.option["series"].push_back(band(x, frame.low, null->high));
    for (Json& one : series) out.option["series"].push_back(std::move(one));
    if (zeros > 0)
      out.notes.push_back(
          fmt::format("In {} of {} cases the median distance is exactly zero, below this axis.", zeros, shown));
    if (null)
      out.notes.push_back(fmt::format("Null level: median {}, 10 % to 90 %: {} to {}.", number_text(null->middle),
                                      number_text(null->low), number_text(null->high)));
    return out;
  }

  /// Distances along the parameter, the median over the starts.
  Figure along() const {
    Figure out = figure("distance", "Distance to the reference along the parameter",
                        "Median over the starts at each value of the parameter.");
    out.linked = true;
    const MethodCurves curves(view_, cases_, "", {}, {});
    out.legend = curves.legend();
    out.legend.push_back({null_name, null_colour, "0 30", "rect"});
    for (const MethodFacet& facet : curves.facets()) {
      Chart chart;
      chart.title = facet.title;
      chart.height = 300;
      for (int k = 0; k < 2; ++k) chart.views.push_back(along_view(facet, k));
      out.charts.push_back(std::move(chart));
    }
    return out;
  }

  ChartView along_view(const MethodFacet& facet, int k) const {
    ChartView out;
    out.x = parameter_;
    out.y = quantity(k);
    Interval heights = range_[k];
    if (heights.empty()) heights = {0.1, 1};
    // What is nearer than a millionth of the farthest is round-off of one and the same orbit.
    const double floor = 1e-6 * heights.high;
    heights.low = std::max(heights.low, floor);
    const bool logarithmic = logarithmic_sweep(parameters_);
    const Json x = logarithmic ? log_axis(out.x, parameters_, false) : value_axis(out.x, padded(parameters_), false);
    out.option = base_option(x, log_axis(out.y, heights, true), false, true);
    std::map<double, std::vector<double>> nulls;
    size_t below = 0;
    for (const MethodCurve& curve : facet.curves) {
      Json data = Json::array();
      for (const CaseRecord* record : curve.cases) {
        std::map<double, std::vector<double>> at;
        for (const Distance& distance : by_case_.at(record->id)) {
          if (distance.value[k]) at[distance.parameter].push_back(*distance.value[k]);
          if (distance.null[k]) nulls[distance.parameter].push_back(*distance.null[k]);
        }
        for (auto& [parameter, values] : at) {
          const double middle = spread_of(values)->middle;
          if (middle < whole_decades(heights).low) ++below;
          data.push_back({parameter, std::max(middle, whole_decades(heights).low)});
        }
      }
      out.option["series"].push_back({{"type", "line"},
                                      {"name", curve.name},
                                      {"symbol", symbol(curve.style)},
                                      {"symbolSize", 4},
                                      {"z", 3},
                                      {"color", curve.colour},
                                      {"itemStyle", {{"color", curve.colour}}},
                                      {"lineStyle", {{"color", curve.colour}, {"width", 1.1}}},
                                      {"data", std::move(data)}});
    }
    Json level = Json::array();
    for (auto& [parameter, values] : nulls)
      level.push_back({parameter, std::max(spread_of(values)->middle, whole_decades(heights).low)});
    if (!level.empty())
      out.option["series"].push_back({{"type", "line"},
                                      {"name", null_name},
                                      {"symbol", "none"},
                                      {"silent", true},
                                      {"z", 1},
                                      {"color", null_colour},
                                      {"lineStyle", {{"width", 0}}},
                                      {"areaStyle", {{"color", null_colour}, {"opacity", 0.75}, {"origin", "start"}}},
                                      {"data", std::move(level)}});
    if (below > 0)
      out.notes.push_back(fmt::format("{} {} below the frame and {} drawn on its lower edge.",
                                      count_text(below, "distance", "distances"), below == 1 ? "lies" : "lie",
                                      below == 1 ? "is" : "are"));
    return out;
  }

  std::vector<double> values_of(const std::string& id, int k) const {
    std::vector<double> out;
    for (const Distance& distance : by_case_.at(id))
      if (distance.value[k]) out.push_back(*distance.value[k]);
    return out;
  }

  static Interval padded(const Interval& range) {
    const double slack =
        range.high > range.low ? 0.02 * (range.high - range.low) : std::max(0.01 * std::abs(range.low), 1e-12);
    return {range.low - slack, range.high + slack};
  }

  static Json band(const Json& x, double low, double high) {
    return {{"type", "line"},
            {"name", null_name},
            {"symbol", "none"},
            {"silent", true},
            {"color", null_colour},
            {"z", 1},
            {"markArea",
             {{"silent", true},
              {"itemStyle", {{"color", null_colour}, {"opacity", 0.75}}},
              {"data", Json::array({Json::array({{{"coord", {x["min"], low}}}, {{"coord", {x["max"], high}}}})})}}},
            {"data", Json::array({Json::array({x["min"], high})})}};
  }

  const CaseView& view_;
  Quantity parameter_;
  std::map<std::string, std::vector<Distance>> by_case_;
  std::vector<double> nulls_[2];
  Interval range_[2] = {Interval::nothing(), Interval::nothing()}, parameters_ = Interval::nothing();
  std::string reference_;
  Cases cases_;
};

}  // namespace

std::vector<Figure> distance_figures(const CaseView& view) {
  const Distances distances(view);
  if (view.results().kind != "bifurcation" || distances.empty()) return {};
  return distances.make();
}

}  // namespace ricochet::report
