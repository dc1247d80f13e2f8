#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/answer.hpp"
#include "runners/report/figures.hpp"
#include "runners/report/html.hpp"
#include "runners/report/options.hpp"

namespace ricochet::report {
namespace {

constexpr size_t series_per_chart = 8;

/// A number of a case on the y axis, nothing where the case has none.
struct Value {
  std::string view;
  Quantity quantity;
  bool logarithmic = false;
  std::optional<double> (*of)(const CaseRecord&);
  /// Drawn hollow (for moduli: what was a gain).
  bool (*hollow)(const CaseRecord&) = nullptr;
};

std::optional<double> ratio(const CaseRecord& record) {
  return CaseView::measure(record, "energy_ratio");
}
std::optional<double> change(const CaseRecord& record) {
  const auto r = ratio(record);
  return r ? std::optional(std::abs(*r - 1)) : std::nullopt;
}
bool gained(const CaseRecord& record) {
  return ratio(record).value_or(0) > 1;
}
std::optional<double> energy_end(const CaseRecord& record) {
  return CaseView::measure(record, "energy_end");
}
std::optional<double> penetration(const CaseRecord& record) {
  return CaseView::measure(record, "deepest_penetration");
}

struct Subject {
  std::string id, title, caption;
  std::vector<Value> values;
};

/// Everything that one chart draws along one axis.
struct Series {
  std::string name, colour;
  size_t style = 0;
  Cases cases;             ///< sorted along the axis
  bool reference = false;  ///< has no such parameter: one value, drawn across
};

class Maker {
 public:
  Maker(const CaseView& view, std::string column) : view_(view), column_(std::move(column)) {
    others_ = view.varying_without({column_});
    facet_columns_ = facet_columns();
    for (const CaseRecord& record : view.results().cases)
      if (const auto x = CaseView::number(record, column_)) x_range_.include(*x);
    x_log_ = x_range_.low > 0 && x_range_.high >= 9 * x_range_.low;
    const std::string unit = axis_unit(column_);
    x_ = {column_ == "step" ? "step h" : column_, unit.empty() ? "1" : unit};
  }

  std::optional<Figure> make(const Subject& subject) const {
    Figure figure{subject.id + "-" + slug(), subject.title + " against " + x_.name, subject.caption, {}, {}, {}, false};
    Cases on_axis, off_axis;
    for (const CaseRecord* record : view_.all())
      (CaseView::number(*record, column_) ? on_axis : off_axis).push_back(record);
    std::vector<std::vector<Series>> series;
    for (const CaseGroup& facet : view_.group(on_axis, facet_columns_)) {
      Chart chart;
      chart.title = facet.label.empty() ? "all cases" : facet.label;
      std::vector<std::string> said = others_;
      said.insert(said.begin(), column_);
      std::erase_if(said, [&](const std::string& c) {
        return std::find(facet_columns_.begin(), facet_columns_.end(), c) != facet_columns_.end();
      });
      chart.notes = outcome_notes(view_, facet.cases, said);
      figure.charts.push_back(std::move(chart));
      series.push_back(series_of(facet, off_axis));
    }
    for (const auto& facet : series)
      for (const Series& s : facet) {
        if (std::any_of(figure.legend.begin(), figure.legend.end(),
                        [&](const LegendEntry& e) { return e.name == s.name; }))
          continue;
        figure.legend.push_back(
            {s.name, s.colour, s.reference ? "2 3" : svg_dash(s.style), s.reference ? "" : symbol(s.style)});
      }
    for (const Value& value : subject.values) add_views(figure, value, series);
    if (figure.views.empty()) return std::nullopt;
    return figure;
  }

 private:
  std::string slug() const {
    std::string out = column_;
    std::replace(out.begin(), out.end(), '.', '-');
    return out;
  }

  /// Columns that must become facets so that no chart has more series than a reader can tell apart.
  std::vector<std::string> facet_columns() const {
    std::vector<std::string> candidates, facets;
    for (const bool methods : {false, true})
      for (const std::string& column : others_)
        if (role_of(column) != "mass" &&
            (role_of(column) != column || column == "contact" || column == "time") == methods)
          candidates.push_back(column);
    for (const std::string& column : candidates) {
      size_t most = 0;
      for (const CaseGroup& facet : view_.group(view_.all(), facets))
        most = std::max(most, view_.group(facet.cases, others_).size());
      if (most <= series_per_chart) break;
      facets.push_back(column);
    }
    return facets;
  }

  std::vector<Series> series_of(const CaseGroup& facet, const Cases& off_axis) const {
    std::vector<std::string> not_mass;
    for (const std::string& column : others_)
      if (role_of(column) != "mass") not_mass.push_back(column);
    const std::vector<CaseGroup> groups = view_.group(facet.cases, not_mass);
    const auto style_of = [&](const CaseRecord& record) {
      for (size_t k = 0; k < groups.size(); ++k)
        if (std::find(groups[k].cases.begin(), groups[k].cases.end(), &record) != groups[k].cases.end()) return k;
      return size_t{0};
    };
    std::vector<Series> out;
    for (CaseGroup& group : view_.group(facet.cases, others_)) {
      const CaseRecord& first = *group.cases.front();
      std::sort(group.cases.begin(), group.cases.end(), [&](const CaseRecord* a, const CaseRecord* b) {
        return CaseView::number(*a, column_).value_or(0) < CaseView::number(*b, column_).value_or(0);
      });
      out.push_back({name(first), view_.colour(first), style_of(first), group.cases, false});
    }
    // Methods without this parameter, otherwise as this chart's: what the parameter's limit is compared with.
    const std::string role = role_of(column_);
    if (role == column_) return out;
    std::vector<std::string> common;
    for (const std::string& column : facet_columns_)
      if (role_of(column) != role) common.push_back(column);
    for (const CaseRecord* record : off_axis) {
      const bool same = std::all_of(common.begin(), common.end(), [&](const std::string& column) {
        return CaseView::text(*record, column) == CaseView::text(*facet.cases.front(), column);
      });
      if (same && record->status == "done" && out.size() < 2 * series_per_chart)
        out.push_back({name(*record), view_.colour(*record), 0, {record}, true});
    }
    return out;
  }

  std::string name(const CaseRecord& record) const {
    std::string label;
    std::vector<std::string> columns;
    for (const std::string& column : others_)
      if (std::find(facet_columns_.begin(), facet_columns_.end(), column) == facet_columns_.end())
        columns.push_back(column);
    label = view_.label(record, columns);
    return !label.empty() ? label : !view_.mass_label(record).empty() ? view_.mass_label(record) : "cases";
  }

  void add_views(Figure& figure, const Value& value, const std::vector<std::vector<Series>>& series) const {
    std::vector<Interval> ranges;
    Interval all = Interval::nothing();
    for (const auto& facet : series) {
      Interval range = Interval::nothing();
      for (const Series& s : facet)
        for (const CaseRecord* record : s.cases) {
          const auto y = value.of(*record);
          if (y && record->status == "done" && (!value.logarithmic || *y > 0)) range.include(*y);
        }
      ranges.push_back(range);
      all.include(range);
    }
    if (all.empty()) return;
    figure.views.push_back(value.view);
    std::vector<Frame> frames = shared_frames(ranges);
    for (size_t f = 0; f < series.size(); ++f)
      figure.charts[f].views.push_back(chart_view(value, series[f], value.logarithmic ? Frame{all, false} : frames[f]));
  }

  ChartView chart_view(const Value& value, const std::vector<Series>& facet, const Frame& frame) const {
    ChartView out;
    out.x = x_;
    out.y = value.quantity;
    Json y;
    if (value.logarithmic) {
      y = log_axis(out.y, frame.range, true);
    } else {
      Interval range = frame.range;
      range = round_outwards(range, 2e-3);
      const bool from_zero = range.low <= 0 && range.high >= 0;
      y = value_axis({with_unit(out.y) + (from_zero ? "" : ", axis not from 0"), "1"}, range, true);
      if (frame.own)
        out.notes.push_back("This chart has its own scale: its values are over 4 times those of most others.");
    }
    Json x = x_log_ ? log_axis(x_, x_range_, false) : value_axis(x_, round_outwards(x_range_, 1e-12), false);
    const double x_low = x["min"].get<double>(), x_high = x["max"].get<double>();
    // The second axis places the marks of cases without a value along the upper edge.
    const Json gutter = {{"type", "value"}, {"min", 0}, {"max", 1}, {"show", false}};
    out.option = base_option(std::move(x), Json::array({std::move(y), gutter}), false, true);
    std::map<double, int> stacked;
    std::string zeros;
    for (const Series& s : facet) {
      Json data = Json::array(), marks = Json::array();
      std::string unseen;
      for (const CaseRecord* record : s.cases) {
        const double at = CaseView::number(*record, column_).value_or(x_low);
        const auto y_value = value.of(*record);
        if (record->status != "done") {
          const double height = 0.95 - 0.085 * stacked[at]++;
          marks.push_back({{"value", {at, height}},
                           {"mark", status_mark(record->status)},
                           {"text", record->status + ": " + record->reason}});
        } else if (y_value && value.logarithmic && !(*y_value > 0)) {
          unseen += fmt::format("{}{}", unseen.empty() ? "" : ", ", exact_text(at));
        } else if (y_value) {
          Json item = {{"value", {at, *y_value}}};
          if (value.hollow && value.hollow(*record))
            item["itemStyle"] = {{"color", "#ffffff"}, {"borderColor", s.colour}, {"borderWidth", 1.6}};
          data.push_back(std::move(item));
        }
      }
      if (!unseen.empty()) zeros += (zeros.empty() ? "" : "; ") + s.name + (s.reference ? "" : " at " + unseen);
      if (s.reference && !data.empty()) {
        const double level = data[0]["value"][1].get<double>();
        data = Json::array({{{"value", {x_low, level}}}, {{"value", {x_high, level}}}});
      }
      out.option["series"].push_back(
          {{"type", "line"},
           {"name", s.name},
           {"symbol", s.reference ? "none" : symbol(s.style)},
           {"symbolSize", 8},
           {"color", s.colour},
           {"itemStyle", {{"color", s.colour}}},
           {"lineStyle",
            {{"color", s.colour}, {"width", s.reference ? 1.2 : 1.6}, {"type", line_dash(s.reference ? 2 : s.style)}}},
           {"data", std::move(data)}});
      if (!marks.empty()) {
        Json series = mark_series(s.name, s.colour, std::move(marks));
        series["yAxisIndex"] = 1;
        out.option["series"].push_back(std::move(series));
      }
    }
    if (!zeros.empty()) out.notes.push_back("Exactly 0, which a logarithmic axis cannot show: " + zeros + ".");
    return out;
  }

  const CaseView& view_;
  std::string column_;
  std::vector<std::string> others_, facet_columns_;
  Quantity x_;
  Interval x_range_ = Interval::nothing();
  bool x_log_ = false;
};

/// Columns worth an axis: the step when it varies, other numbers with at least three values.
std::vector<std::string> axis_columns(const CaseView& view) {
  std::vector<std::string> out;
  for (const std::string& column : view.varying()) {
    const auto cases = view.all();
    const bool numeric = std::any_of(cases.begin(), cases.end(),
                                     [&](const CaseRecord* r) { return CaseView::number(*r, column).has_value(); });
    if (!numeric) continue;
    if (column == "step")
      out.insert(out.begin(), column);
    else if (view.values(column).size() >= 3)
      out.push_back(column);
  }
  return out;
}

}  // namespace

std::vector<Figure> axis_figures(const CaseView& view) {
  std::vector<Subject> subjects = {
      {"final-energy",
       "Energy at the end",
       "One colour per mass matrix. Where the modulus of the change is shown, full marks lost energy and hollow marks "
       "gained it.",
       {{"|E(T) / E(0) − 1|", {"|E(T) / E(0) − 1|", "1"}, true, change, gained},
        {"E(T) / E(0)", {"E(T) / E(0)", "1"}, false, ratio},
        {"E(T) (J)", {"energy at the end E(T)", "J"}, true, energy_end}}},
      {"penetration",
       "Deepest penetration",
       "The largest distance by which a contact point passed its stop, over every step. 2⁻⁵² of the stop's own "
       "position is round-off.",
       {{"deepest penetration (m)", {"deepest penetration", "m"}, true, penetration}}}};
  // Where damping or loads work, the change from the start says little: the ratio comes first.
  if (!conservative(view)) std::swap(subjects[0].values[0], subjects[0].values[1]);
  std::vector<Figure> out;
  for (const Subject& subject : subjects)
    for (const std::string& column : axis_columns(view))
      if (auto figure = Maker(view, column).make(subject)) out.push_back(std::move(*figure));
  return out;
}

}  // namespace ricochet::report
