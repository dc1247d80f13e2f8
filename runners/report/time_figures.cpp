#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runners/report/figures.hpp"
#include "runners/report/html.hpp"
#include "runners/report/options.hpp"

namespace ricochet::report {
namespace {

constexpr size_t drawn_whole =
    4000;  // points of a curve up to which every one is drawn; a chart is about 500 pixels wide

enum class Scale { value, ratio, change };

/// A figure over time: one column of the curves, in one or several scales.
struct Subject {
  std::string id, title, caption, column;
  Quantity quantity;
  std::vector<Scale> scales;
  bool from_zero = false, with_stops = false;
};

/// What is drawn of one case: its place in the page's data, its values, its looks.
struct Drawn {
  const CaseRecord* record = nullptr;
  Json reference;
  std::span<const double> t, values;
  std::string name, colour;
  size_t rank = 0;
};

/// y = scale·(v − base), or its modulus; subtracting first keeps an unchanged value exactly 0.
struct Map {
  double base = 0, scale = 1;
  bool modulus = false;
  double operator()(double v) const { return modulus ? std::abs(scale * (v - base)) : scale * (v - base); }
};

std::optional<double> start_value(const CaseRecord& record, std::span<const double> values) {
  const auto measured = CaseView::measure(record, "energy_start");
  const double start = measured ? *measured : values.empty() ? 0 : values.front();
  return start > 0 ? std::optional(start) : std::nullopt;
}

std::optional<Map> map_of(Scale scale, const Drawn& drawn) {
  if (scale == Scale::value) return Map{};
  const auto start = start_value(*drawn.record, drawn.values);
  if (!start) return std::nullopt;
  return scale == Scale::ratio ? Map{0, 1 / *start, false} : Map{*start, 1 / *start, true};
}

Quantity quantity_of(Scale scale, const Subject& subject) {
  if (scale == Scale::value) return subject.quantity;
  return scale == Scale::ratio ? Quantity{"E / E(0)", "1"} : Quantity{"|E / E(0) − 1|", "1"};
}

/// Columns told apart within one facet: the step; else the mass; else the first column that varies.
std::vector<std::string> curve_columns(const CaseView& view) {
  if (view.varies("step")) return {"step"};
  std::vector<std::string> out;
  for (const std::string& column : view.varying())
    if (role_of(column) == "mass") out.push_back(column);
  if (out.empty() && !view.varying().empty()) out.push_back(view.varying().front());
  return out;
}

/// Finest step first; other values in order of appearance.
std::vector<std::string> ranked(const CaseView& view, const std::vector<std::string>& columns) {
  std::vector<std::pair<double, std::string>> order;
  for (const CaseRecord& record : view.results().cases) {
    const std::string name = view.label(record, columns);
    if (std::none_of(order.begin(), order.end(), [&](const auto& o) { return o.second == name; }))
      order.emplace_back(columns == std::vector<std::string>{"step"} ? CaseView::number(record, "step").value_or(0)
                                                                     : static_cast<double>(order.size()),
                         name);
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> out;
  for (auto& [rank, name] : order) out.push_back(name);
  return out;
}

class Maker {
 public:
  Maker(const CaseView& view, CurveData& curves)
      : view_(view), curves_(curves), curve_columns_(curve_columns(view)), ranks_(ranked(view, curve_columns_)) {
    by_mass_ = !curve_columns_.empty() && role_of(curve_columns_.front()) == "mass";
  }

  std::optional<Figure> make(const Subject& subject) {
    const std::vector<CaseGroup> facets = view_.group(view_.all(), view_.varying_without(curve_columns_));
    std::vector<std::vector<Drawn>> drawn;
    bool any = false, has_start = false, thinned = false;
    for (const CaseGroup& facet : facets) {
      drawn.push_back(curves_of(facet, subject));
      for (const Drawn& d : drawn.back()) {
        any = true;
        has_start = has_start || start_value(*d.record, d.values);
        thinned = thinned || d.values.size() > drawn_whole;
      }
    }
    if (!any) return std::nullopt;

    Figure figure{subject.id, subject.title, subject.caption, {}, {}, legend(), true};
    if (thinned)
      figure.caption += fmt::format(
          " Of curves over {} points the smallest and the largest of each pixel are drawn; zooming in shows every "
          "sample.",
          drawn_whole);
    for (size_t f = 0; f < facets.size(); ++f) {
      Chart chart;
      chart.title = facets[f].label.empty() ? "all cases" : facets[f].label;
      chart.notes = outcome_notes(view_, facets[f].cases, curve_columns_);
      figure.charts.push_back(std::move(chart));
    }
    for (const Scale scale : subject.scales) {
      if (scale != Scale::value && !has_start) continue;
      figure.views.push_back(with_unit(quantity_of(scale, subject)));
      std::vector<Interval> ranges;
      for (const auto& facet : drawn) ranges.push_back(range_of(facet, scale));
      std::vector<Frame> frames = shared_frames(ranges);
      if (scale == Scale::change) {
        Interval all = Interval::nothing();
        for (const Interval& range : ranges) all.include(range);
        for (Frame& frame : frames) frame = {all, false};
      }
      for (size_t f = 0; f < facets.size(); ++f)
        if (!drawn[f].empty()) figure.charts[f].views.push_back(chart_view(subject, scale, drawn[f], frames[f]));
    }
    return figure;
  }

 private:
  std::vector<Drawn> curves_of(const CaseGroup& facet, const Subject& subject) {
    std::vector<Drawn> out;
    for (const CaseRecord* record : facet.cases) {
      auto reference = curves_.series(*record, "t", subject.column);
      if (!reference) continue;
      Drawn d;
      d.record = record;
      d.reference = std::move(*reference);
      d.t = *curve_column(record->curve, "t");
      d.values = *curve_column(record->curve, subject.column);
      d.name = name_of(*record);
      const std::string label = view_.label(*record, curve_columns_);
      d.rank = static_cast<size_t>(std::find(ranks_.begin(), ranks_.end(), label) - ranks_.begin());
      d.colour = by_mass_ ? view_.colour(*record) : lighten(view_.colour(*record), shade(d.rank));
      out.push_back(std::move(d));
    }
    // The finest last, on top of the others.
    std::stable_sort(out.begin(), out.end(), [](const Drawn& a, const Drawn& b) { return a.rank > b.rank; });
    return out;
  }

  std::string name_of(const CaseRecord& record) const {
    const std::string label = view_.label(record, curve_columns_);
    return !label.empty() ? label : !view_.mass_label(record).empty() ? view_.mass_label(record) : "curve";
  }

  /// Coarser steps are wider and lighter: where curves coincide, each still shows beside the finest.
  double width(size_t rank) const {
    return by_mass_ ? 1.6 : 1.4 + 0.8 * static_cast<double>(std::min<size_t>(rank, 3));
  }

  double shade(size_t rank) const {
    return ranks_.size() < 2 ? 0 : 0.5 * static_cast<double>(rank) / static_cast<double>(ranks_.size() - 1);
  }

  std::vector<LegendEntry> legend() const {
    std::vector<LegendEntry> out;
    for (const CaseRecord& record : view_.results().cases) {
      const std::string name = name_of(record), label = view_.label(record, curve_columns_);
      if (std::any_of(out.begin(), out.end(), [&](const LegendEntry& e) { return e.name == name; })) continue;
      const auto rank = static_cast<size_t>(std::find(ranks_.begin(), ranks_.end(), label) - ranks_.begin());
      const std::string base = view_.masses().size() > 1 ? "#555555" : view_.colour(record);
      out.push_back(
          {name, by_mass_ ? view_.colour(record) : lighten(base, shade(rank)), by_mass_ ? "" : svg_dash(rank), ""});
    }
    return out;
  }

  /// Of the finished curves, and of the others as far as they stay in sight: up to three times their start where none
  /// finished, up to a thousand times the finished ones on a logarithmic axis.
  static Interval range_of(const std::vector<Drawn>& facet, Scale scale) {
    Interval range = Interval::nothing();
    const auto include = [&](bool finished, double bound) {
      for (const Drawn& d : facet) {
        const auto map = map_of(scale, d);
        if (!map || (d.record->status == "done") != finished) continue;
        for (const double v : d.values) {
          const double y = (*map)(v);
          if (std::abs(y) <= bound && (scale != Scale::change || y > 0)) range.include(y);
        }
      }
    };
    include(true, INFINITY);
    if (scale == Scale::change) {
      include(false, range.empty() ? 1e6 : 1e3 * std::max(1.0, range.high));
    } else if (range.empty()) {
      double start = 0;
      for (const Drawn& d : facet)
        if (const auto map = map_of(scale, d)) start = std::max(start, std::abs((*map)(d.values.front())));
      include(false, start > 0 ? 3 * start : INFINITY);
    }
    return range;
  }

  ChartView chart_view(const Subject& subject, Scale scale, const std::vector<Drawn>& facet, const Frame& frame) const {
    ChartView out;
    out.x = {"t", "s"};
    out.y = quantity_of(scale, subject);
    if (frame.range.empty() && scale == Scale::change) {
      out.notes.push_back("No sample differs from the start: a logarithmic axis has nothing to show.");
      return out;
    }
    Interval range = frame.range.empty() ? Interval{0, 1} : frame.range;
    Json y;
    if (scale == Scale::change) {
      range = whole_decades(range);
      y = log_axis(out.y, range, true);
    } else {
      if (scale == Scale::value && subject.from_zero) range.include(0);
      if (subject.with_stops)
        for (const double stop : stops()) range.include(1.04 * stop);
      range = round_outwards(range, scale == Scale::ratio ? 2e-3 : 1e-12);
      const bool from_zero = range.low <= 0 && range.high >= 0;
      y = value_axis({with_unit(out.y) + (from_zero ? "" : ", axis not from 0"), "1"}, range, true);
      if (frame.own)
        out.notes.push_back("This chart has its own scale: its values are over 4 times those of most others.");
    }
    Interval time = Interval::nothing();
    for (const Drawn& d : facet) time.include({d.t.front(), d.t.back()});
    if (time.low > 0 && time.low < 0.01 * time.high) time.low = 0;
    Json x = value_axis(out.x, time, false);
    out.option = base_option(std::move(x), std::move(y), true, false);
    std::string unseen;
    for (const Drawn& d : facet) add_curve(out, d, scale, range, unseen);
    if (!unseen.empty())
      out.notes.push_back("Samples equal to the start exactly, which a logarithmic axis cannot show: " + unseen + ".");
    if (subject.with_stops && !stops().empty()) out.option["series"].push_back(stop_lines());
    return out;
  }

  void add_curve(ChartView& out, const Drawn& d, Scale scale, const Interval& range, std::string& unseen) const {
    const auto map = map_of(scale, d);
    if (!map) {
      out.notes.push_back(d.name + ": energy 0 at the start, so no ratio to it.");
      return;
    }
    Json data = d.reference;
    if (map->scale != 1) data["scale"] = map->scale;
    if (map->base != 0) data["base"] = map->base;
    if (map->modulus) data["modulus"] = true;
    Json series = {
        {"type", "line"},
        {"name", d.name},
        {"showSymbol", d.values.size() < 2},
        {"color", d.colour},
        {"lineStyle",
         {{"color", d.colour}, {"width", width(d.rank)}, {"type", by_mass_ ? Json("solid") : line_dash(d.rank)}}},
        {"emphasis", {{"disabled", true}}},
        {"data", std::move(data)}};
    if (d.values.size() > drawn_whole) series["sampling"] = "minmax";
    out.option["series"].push_back(std::move(series));

    size_t zeros = 0;
    double largest = 0;
    for (const double v : d.values) {
      const double mapped = (*map)(v);
      zeros += mapped == 0;
      if (std::isfinite(mapped) && std::abs(mapped) > std::abs(largest)) largest = mapped;
    }
    if (scale == Scale::change && zeros > 0)
      unseen += fmt::format("{}{} {} of {}", unseen.empty() ? "" : ", ", d.name, zeros, d.values.size());
    if (largest > range.high || largest < range.low)
      out.notes.push_back(fmt::format("{}: leaves the frame, up to {}{}.", d.name, number_text(largest),
                                      out.y.unit == "1" ? "" : " " + out.y.unit));
    if (d.record->status != "done") add_end(out, d, *map, range);
  }

  /// A mark where a curve that did not finish stops.
  static void add_end(ChartView& out, const Drawn& d, const Map& map, const Interval& range) {
    size_t last = d.values.size();
    while (last > 0 && !std::isfinite(map(d.values[last - 1]))) --last;
    if (last == 0) return;
    const double t = d.t[last - 1], value = map(d.values[last - 1]);
    const double shown = std::clamp(value, range.low, range.high);
    const std::string text = fmt::format("{} at t = {} s: {}", d.record->status, number_text(t), d.record->reason);
    out.option["series"].push_back(
        mark_series(d.name, d.colour,
                    Json::array({{{"value", {t, shown}}, {"mark", status_mark(d.record->status)}, {"text", text}}})));
  }

  /// Positions of the stops where the study gives them as plain numbers.
  std::vector<double> stops() const {
    std::vector<double> out;
    const Json::json_pointer place("/scene/stops");
    if (!view_.results().study.is_object() || !view_.results().study.contains(place)) return out;
    for (const char* side : {"lower", "upper"}) {
      const Json stop = view_.results().study.at(place).value(side, Json());
      if (stop.is_number()) out.push_back(stop.get<double>());
      if (!stop.is_string()) continue;
      const std::string text = stop.get<std::string>();
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      if (end != text.c_str() && *end == 0 && std::isfinite(value)) out.push_back(value);
    }
    return out;
  }

  Json stop_lines() const {
    Json lines = Json::array();
    for (const double stop : stops()) lines.push_back({{"yAxis", stop}});
    return {{"type", "line"},
            {"name", "stops"},
            {"data", Json::array()},
            {"silent", true},
            {"tooltip", {{"show", false}}},
            {"markLine",
             {{"silent", true},
              {"symbol", "none"},
              {"animation", false},
              {"label",
               {{"show", true},
                {"formatter", "stop"},
                {"position", "insideStartTop"},
                {"fontSize", 10},
                {"color", "#777777"}}},
              {"lineStyle", {{"color", "#777777"}, {"type", "solid"}, {"width", 1}}},
              {"data", lines}}}};
  }

  const CaseView& view_;
  CurveData& curves_;
  std::vector<std::string> curve_columns_, ranks_;
  bool by_mass_ = false;
};

}  // namespace

std::vector<Figure> time_figures(const CaseView& view, CurveData& curves) {
  const std::vector<Subject> subjects = {
      {"energy",
       "Energy against time",
       "Mechanical energy ½vᵀMv + ½qᵀKq plus that stored in compliant contacts, at the time where each scheme's "
       "velocity stands "
       "(the end of a step, or its middle).",
       "energy",
       {"energy E", "J"},
       {Scale::value, Scale::ratio, Scale::change},
       true,
       false},
      {"tip",
       "Tip displacement",
       "Absolute displacement at the free end, motion of the support included.",
       "tip_displacement",
       {"tip displacement", "m"},
       {Scale::value},
       false,
       true},
      {"force",
       "Contact force",
       "Sum over the contact points at the sampled instants; a peak between two samples does not show.",
       "contact_force",
       {"contact force", "N"},
       {Scale::value},
       true,
       false}};
  Maker maker(view, curves);
  std::vector<Figure> out;
  for (const Subject& subject : subjects)
    if (auto figure = maker.make(subject)) out.push_back(std::move(*figure));
  return out;
}

size_t series_shown(const StudyResults& results) {
  size_t count = 0;
  for (const CaseRecord& record : results.cases) count += record.curve.columns.empty() ? 0 : 4;
  return count;
}

}  // namespace ricochet::report
