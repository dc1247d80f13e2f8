#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/evidence.hpp"
#include "runners/report/html.hpp"
#include "runners/report/method_curves.hpp"
#include "runners/report/options.hpp"
#include "runners/report/work_precision.hpp"

namespace ricochet::report {
namespace {

constexpr const char* grey = "#b3b3b3";
constexpr const char* front_colour = "#E8D95A";
constexpr const char* front_name = "Pareto front";
constexpr const char* floor_name = "error floor";
constexpr const char* floor_colour = "#7a7a7a";
constexpr int slots = 40;  // of the hidden axis that places marks in the gutter
constexpr int gutter_columns = 4, gutter_rows = 11;
constexpr double gutter_share = 0.13;  // of the decades of the axis

double seconds_of(const WorkPoint& p) {
  return p.seconds;
}
double steps_of(const WorkPoint& p) {
  return p.steps;
}
double microseconds_of(const WorkPoint& p) {
  return p.steps > 0 ? 1e6 * p.seconds / p.steps : 0;
}

/// What stands on the vertical axis.
struct Work {
  std::string id, title, caption;
  Quantity quantity;
  double (*of)(const WorkPoint&);
  bool spread = false, front = false;
};

class WorkFigure {
 public:
  explicit WorkFigure(const CaseView& view)
      : view_(view), work_(view), curves_(view, view.all(), "step", work_.scene_columns(), {}) {}

  std::optional<Figure> make(const Work& work) const {
    Figure figure{work.id, work.title, curves_.colours_text() + work.caption, {}, {}, curves_.legend(), false};
    for (const MethodFacet& facet : curves_.facets())
      figure.charts.push_back({facet.title, {}, outcome_notes(view_, facet.cases, curves_.said())});
    bool floors = false;
    for (const std::string& error : work_.errors()) {
      Interval x = Interval::nothing(), y = Interval::nothing();
      bool gutter = false;
      for (const CaseRecord& record : view_.results().cases) {
        const auto p = work_.point(record, error);
        gutter = gutter || !p;
        if (!p || !(work.of(*p) > 0)) continue;
        x.include(p->error);
        y.include(work.of(*p));
        if (work.spread) y.include(Interval{p->low, p->high});
      }
      if (x.empty()) continue;
      x = whole_decades(x);
      figure.views.push_back(error);
      for (size_t f = 0; f < figure.charts.size(); ++f)
        figure.charts[f].views.push_back(chart_view(work, error, curves_.facets()[f], x, y, gutter, floors));
    }
    if (figure.views.empty()) return std::nullopt;
    if (work.front) figure.legend.push_back({front_name, front_colour, "", ""});
    if (floors) figure.legend.push_back({floor_name, floor_colour, svg_dash(2), ""});
    return figure;
  }

 private:
  /// The cases of a facet's scene, which the front is of.
  Cases scene_of(const MethodFacet& facet) const {
    for (CaseGroup& scene : view_.group(view_.all(), work_.scene_columns()))
      if (std::find(scene.cases.begin(), scene.cases.end(), facet.cases.front()) != scene.cases.end())
        return std::move(scene.cases);
    return facet.cases;
  }

  /// The methods on the front are said once, below the first chart of their scene.
  bool first_of_scene(const MethodFacet& facet) const {
    for (const MethodFacet& other : curves_.facets()) {
      if (&other == &facet) return true;
      const auto same = [&](const std::string& column) {
        return CaseView::text(*other.cases.front(), column) == CaseView::text(*facet.cases.front(), column);
      };
      if (std::all_of(work_.scene_columns().begin(), work_.scene_columns().end(), same)) return false;
    }
    return true;
  }

  ChartView chart_view(const Work& work, const std::string& error, const MethodFacet& facet, Interval x_range,
                       const Interval& y_range, bool gutter, bool& floors) const {
    ChartView out;
    out.x = error_quantity(error);
    out.y = work.quantity;
    const double edge = x_range.high;
    const double far = gutter ? edge * std::pow(edge / x_range.low, gutter_share) : edge;
    // Marks of cases without an error have no place along x: a hidden axis of slots puts them into the gutter.
    Json names = Json::array();
    for (int k = 0; k < slots; ++k) names.push_back("slot " + std::to_string(k));
    const Json hidden_x = {{"type", "category"}, {"data", std::move(names)}, {"show", false}};
    const Json hidden_y = {{"type", "value"}, {"min", 0}, {"max", 1}, {"show", false}};
    Json x = log_axis(out.x, x_range, false);
    x["max"] = far;
    out.option = base_option(Json::array({std::move(x), hidden_x}),
                             Json::array({log_axis(out.y, y_range, true), hidden_y}), false, true);

    const std::vector<WorkPoint> all = work_.points(scene_of(facet), error);
    if (work.front) draw_front(work, all, first_of_scene(facet), out);
    const std::vector<size_t> front = work.front ? pareto_front(all, work.of) : std::vector<size_t>{};
    const auto on_front = [&](const CaseRecord& record) {
      return std::any_of(front.begin(), front.end(), [&](size_t k) { return all[k].record == &record; });
    };

    int marks_drawn = 0;
    double floor = 0;
    std::string unmarked;
    for (const MethodCurve& curve : facet.curves) {
      Json data = Json::array(), bars = Json::array(), marks = Json::array();
      for (const CaseRecord* record : curve.cases) {
        const auto p = work_.point(*record, error);
        if (!p || !(work.of(*p) > 0)) {
          if (gutter) marks.push_back(gutter_mark(*record, error, marks_drawn++));
          continue;
        }
        floor = std::max(floor, p->floor);
        Json item = {{"value", {p->error, work.of(*p)}}, {"text", point_text(*p, on_front(*record))}};
        if (p->error <= p->floor) item["itemStyle"] = {{"color", grey}};
        if (on_front(*record)) item["symbolSize"] = 12;
        data.push_back(std::move(item));
        if (work.spread && p->high > p->low) {
          for (const double end : {p->low, p->high})
            bars.push_back({{"value", {p->error, end}}, {"text", point_text(*p, on_front(*record))}});
          bars.push_back({{"value", {"-", "-"}}});
        }
      }
      if (!bars.empty())
        out.option["series"].push_back({{"type", "line"},
                                        {"name", curve.name},
                                        {"symbol", "rect"},
                                        {"symbolSize", {9, 1.2}},
                                        {"color", curve.colour},
                                        {"lineStyle", {{"color", curve.colour}, {"width", 1}, {"type", "solid"}}},
                                        {"data", std::move(bars)}});
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
        series["xAxisIndex"] = 1;
        series["yAxisIndex"] = 1;
        out.option["series"].push_back(std::move(series));
      }
    }
    if (floor >= x_range.low) {
      floor_line(floor, out);
      floors = true;
    }
    if (gutter) gutter_area(edge, far, out);
    say_without(facet, error, out);
    return out;
  }

  /// Low left corner of what was reached: its line, and the methods on it.
  void draw_front(const Work& work, const std::vector<WorkPoint>& all, bool say, ChartView& out) const {
    Json data = Json::array();
    std::vector<std::string> columns = view_.varying_without({"step"}), on, near;
    std::erase_if(columns, [&](const std::string& c) {
      const auto& scene = work_.scene_columns();
      return std::find(scene.begin(), scene.end(), c) != scene.end();
    });
    const auto add = [](std::vector<std::string>& list, std::string text) {
      if (!text.empty() && std::find(list.begin(), list.end(), text) == list.end()) list.push_back(std::move(text));
    };
    for (const size_t k : pareto_front(all, work.of)) {
      data.push_back(
          {{"value", {all[k].known(), work.of(all[k])}}, {"text", "no case is both faster and more precise"}});
      add(on, view_.label(*all[k].record, columns));
    }
    for (const WorkPoint& p : all)
      if (work.spread && !told_from_front(p, all)) add(near, view_.label(*p.record, columns));
    std::erase_if(near, [&](const std::string& text) { return std::find(on.begin(), on.end(), text) != on.end(); });
    if (say && !on.empty()) out.notes.push_back(fmt::format("On the front: {}.", fmt::join(on, "; ")));
    if (say && !near.empty())
      out.notes.push_back(fmt::format("Not told from the front, since the spreads of their times overlap it: {}.",
                                      fmt::join(near, "; ")));
    out.option["series"].push_back({{"type", "line"},
                                    {"name", front_name},
                                    {"symbol", data.size() == 1 ? "circle" : "none"},
                                    {"symbolSize", 18},
                                    {"z", 1},
                                    {"color", front_colour},
                                    {"lineStyle", {{"color", front_colour}, {"width", 9}, {"cap", "round"}}},
                                    {"data", std::move(data)}});
  }

  Json gutter_mark(const CaseRecord& record, const std::string& error, int count) const {
    const int column = slots - 1 - count / gutter_rows % gutter_columns;
    const bool done = record.status == "done";
    const std::string who = view_.label(record, curves_.said());
    const std::string why = done ? work_.why_none(record, error) : record.status + ": " + record.reason;
    return {{"value", {"slot " + std::to_string(column), 0.95 - 0.085 * (count % gutter_rows)}},
            {"mark", done ? "–" : status_mark(record.status)},
            {"text", who.empty() ? why : who + ": " + why}};
  }

  void say_without(const MethodFacet& facet, const std::string& error, ChartView& out) const {
    std::vector<std::pair<std::string, size_t>> counts;
    for (const CaseRecord* record : facet.cases) {
      if (record->status != "done") continue;
      const std::string why = work_.why_none(*record, error);
      if (why.empty()) continue;
      auto found = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.first == why; });
      if (found == counts.end()) found = counts.insert(counts.end(), {why, 0});
      ++found->second;
    }
    for (const auto& [why, count] : counts)
      out.notes.push_back("– " + count_text(count, "finished case", "finished cases") + ": " + why);
  }

  static std::string point_text(const WorkPoint& p, bool on_front) {
    std::string out = fmt::format("step {} s: {} s", exact_text(CaseView::number(*p.record, "step").value_or(0)),
                                  number_text(p.seconds, 3));
    if (p.high > p.low) out += fmt::format(" [{}, {}]", number_text(p.low, 3), number_text(p.high, 3));
    if (p.steps > 0)
      out += fmt::format(", {} steps, {} µs each", exact_text(p.steps), number_text(microseconds_of(p), 3));
    if (p.error <= p.floor) out += fmt::format("; at or below the error floor of {}", number_text(p.floor, 3));
    return out + (on_front ? "; on the front" : "");
  }

  static Json& first_curve(ChartView& out) {
    for (Json& series : out.option["series"])
      if (series["type"] == "line" && series["name"] != front_name && series["symbol"] != "rect") return series;
    return out.option["series"][0];
  }

  static void floor_line(double floor, ChartView& out) {
    const Json& y = out.option["yAxis"][0];
    Json data = Json::array();
    for (const char* end : {"min", "max"})
      data.push_back(
          {{"value", {floor, y[end]}}, {"text", "errors below " + number_text(floor, 3) + " are not told apart"}});
    out.option["series"].push_back({{"type", "line"},
                                    {"name", floor_name},
                                    {"symbol", "none"},
                                    {"z", 1},
                                    {"color", floor_colour},
                                    {"lineStyle", {{"color", floor_colour}, {"width", 1.2}, {"type", line_dash(2)}}},
                                    {"data", std::move(data)}});
  }

  static void gutter_area(double from, double to, ChartView& out) {
    if (out.option["series"].empty()) return;
    first_curve(out)["markArea"] = {
        {"silent", true},
        {"itemStyle", {{"color", "#000000"}, {"opacity", 0.05}}},
        {"label", {{"show", true}, {"position", "insideBottom"}, {"color", "#7a7a7a"}, {"fontSize", 10}}},
        {"data", Json::array({Json::array({{{"name", "no error"}, {"xAxis", from}}, {{"xAxis", to}}})})}};
  }

  const CaseView& view_;
  WorkPrecision work_;
  MethodCurves curves_;
};

}  // namespace

std::vector<Figure> work_precision_figures(const CaseView& view) {
  const WorkPrecision work(view);
  std::vector<Figure> out;
  if (work.empty()) return out;
  const std::string gutter =
      " The grey strip at the right holds the cases without an error: refused ⊘, diverged ✕, failed !, or no such "
      "error –.";
  const Work works[] = {
      {"work-precision",
       "Run time against error",
       " Each point is one step of its method; left and low is better. The band is the Pareto front of all methods of "
       "the scene: no case is both faster and more precise. Bars: fastest and slowest repeat." +
           gutter,
       {"run time", "s"},
       seconds_of,
       true,
       true},
      {"steps-precision", "Steps against error", gutter, {"steps", "1"}, steps_of, false, true},
      {"step-cost", "Time per step against error", gutter, {"time per step", "µs"}, microseconds_of, false, false}};
  const WorkFigure maker(view);
  for (const Work& one : works)
    if (auto figure = maker.make(one)) out.push_back(std::move(*figure));
  return out;
}

}  // namespace ricochet::report
