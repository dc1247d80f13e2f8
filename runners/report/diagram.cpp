#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/report/dynamics_report.hpp"
#include "runners/report/evidence_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/options.hpp"
#include "runners/report/orbit_data.hpp"
#include "runners/report/orbits.hpp"

namespace ricochet::report {
namespace {

constexpr const char* ink = "#222222";
constexpr const char* faint = "#9a9a9a";
constexpr std::array method_colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
                                       "#7B4FA0", "#8C6D31", "#44AA99", "#882255", "#333333", "#999933"};
constexpr size_t most_lanes = 24;         ///< rows of a band of regimes
constexpr size_t most_start_charts = 48;  ///< charts of the view by start

struct Verdict {
  const char *word, *colour;
};
constexpr Verdict verdicts[] = {{"robust", "#8CC9A6"}, {"depends", "#F2A65A"}, {"undecided", "#DADADA"}};

/// The cases and starts of one chart.
struct Panel {
  std::string title;
  Cases cases;
  std::optional<size_t> kind;  ///< of start; nothing: all
  bool by_method = false;      ///< colour tells cases apart, not regimes
};

class Diagram {
 public:
  explicit Diagram(const CaseView& view) : view_(view), parameter_(swept_parameter(view.results())) {
    std::vector<double> first_exponents;
    for (const CaseRecord* record : view.all()) {
      const std::vector<Orbit> orbits = orbits_of(*record);
      if (orbits.empty()) continue;
      cases_.push_back(record);
      Interval points = Interval::nothing();
      if (const NumberTable* table = find_table(record->numbers, "points"))
        if (const auto* column = table->numbers("tip_displacement"))
          for (const double value : *column) points.include(value);
      heights_.emplace(record->id, points);
      for (const Orbit& orbit : orbits) {
        parameters_.include(orbit.parameter);
        kinds_.insert(start_kind(orbit.start));
        groups_.insert(regime_group(orbit));
        has_.insert({record->id, regime_group(orbit), start_kind(orbit.start)});
        if (orbit.twin) twins_ = true;
        most_exponents_ = std::max(most_exponents_, orbit.exponents.size());
        if (orbit.exponents.empty()) continue;
        first_exponents.push_back(orbit.exponents.front().value);
        ++methods_[orbit.exponent_method];
        if (!orbit.marginal.empty()) ++marginal_;
      }
    }
    frame_exponents(std::move(first_exponents));
  }

  bool empty() const { return cases_.empty() || parameters_.empty(); }

  Figure make(CurveData& curves) const {
    Figure figure{"diagram", "Bifurcation diagram", "", {}, {}, {}, false};
    figure.linked = true;
    figure.caption = caption() + " " + put_points(view_, curves);
    if (const std::string portraits = put_portraits(view_, curves); !portraits.empty())
      figure.caption += " " + portraits;
    const std::vector<Frame> frames = height_frames();
    std::vector<Panel> panels;
    figure.views.push_back(cases_.size() > 1 ? "side by side" : "diagram");
    for (const CaseRecord* record : cases_) panels.push_back({title(*record), {record}, std::nullopt, false});
    for (size_t p = 0; p < panels.size(); ++p) add(figure, panels[p], frames[p], 0);
    if (cases_.size() > 1) {
      figure.views.push_back("overlaid");
      Interval all = Interval::nothing();
      for (const Frame& frame : frames) all.include(frame.range);
      add(figure, {"all methods", cases_, std::nullopt, true}, {all, false}, static_cast<int>(figure.views.size()) - 1);
    }
    if (kinds_.size() > 1 && kinds_.size() * cases_.size() <= most_start_charts) {
      figure.views.push_back("by start");
      const int view = static_cast<int>(figure.views.size()) - 1;
      for (size_t c = 0; c < cases_.size(); ++c)
        for (const size_t kind : kinds_) {
          const std::string name = cases_.size() > 1 ? title(*cases_[c]) + " · " : "";
          add(figure, {name + start_kinds[kind].name, {cases_[c]}, kind, false}, frames[c], view);
        }
    }
    if (cases_.size() > method_colours.size())
      figure.caption += fmt::format(" Overlaid, colours repeat after {} methods: the legend shows any of them alone.",
                                    method_colours.size());
    add_legend(figure);
    return figure;
  }

 private:
  std::string title(const CaseRecord& record) const {
    const std::string label = view_.label(record);
    return (label.empty() ? "all cases" : label) + (is_partial(record) ? " (partial)" : "");
  }

  std::string colour_of(const CaseRecord& record) const {
    const auto at = std::find(cases_.begin(), cases_.end(), &record) - cases_.begin();
    return method_colours[static_cast<size_t>(at) % method_colours.size()];
  }

  std::string method_name(const CaseRecord& record) const {
    const std::string label = view_.label(record);
    return label.empty() ? "the one method" : label;
  }

  std::string caption() const {
    const Json& study = view_.results().study;
    const std::string section = study.value("section", "");
    std::string when = section == "impact"     ? "at each impact"
                       : section == "extremum" ? "at each extremum of the tip"
                                               : "once in each forcing period";
    if (section == "strobe")
      if (const double phase = study.value("phase", 0.0); phase != 0)
        when += fmt::format(" (phase {} rad)", number_text(phase));
    std::string out =
        fmt::format("Tip displacement {}, against {}; absolute, support motion included.", when, parameter_.name);
    if (!frame_.empty()) {
      out += " Under it: the largest Lyapunov exponent (1/s) with its interval";
      std::string by;
      size_t all = 0;
      for (const auto& [method, count] : methods_) all += count;
      for (const auto& [method, count] : methods_)
        by += (by.empty() ? "" : ", ") + (method.empty() ? std::string("method not said") : method) +
              (methods_.size() > 1 ? fmt::format(" ({} of {})", count, all) : "");
      out += ", by " + by;
      if (marginal_ > 0)
        out += fmt::format("; at {} an exponent of a marginal root, the scheme's own, is set apart",
                           count_text(marginal_, "value and start", "values and starts"));
      out += "; then the regime of each start.";
    } else {
      out += " Under it: the regime of each start.";
    }
    if (!verdict_rows().empty()) out += " Last: what all methods together say of each interval.";
    return out + " Symbols tell starts apart; dense clouds are dots. Click a point for its orbit.";
  }

  void frame_exponents(std::vector<double> values) {
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    // Orbits that contract almost at once have exponents far below all others, which must not flatten these.
    const double median = values[values.size() / 2], high = std::max(values.back(), 0.0);
    const double least = std::min(median, 0.0) - 4 * std::max({high, std::abs(median), 1e-12});
    frame_ = Interval::nothing();
    frame_.include(0);
    for (const double value : values)
      if (value >= least) frame_.include(value);
    frame_ = round_outwards(frame_, 1e-12);
    below_ = std::count_if(values.begin(), values.end(), [&](double v) { return v < frame_.low; });
  }

  std::vector<Frame> height_frames() const {
    std::vector<Interval> ranges;
    for (const CaseRecord* record : cases_) ranges.push_back(heights_.at(record->id));
    std::vector<Frame> out = shared_frames(ranges);
    for (Frame& frame : out)
      if (!frame.range.empty()) frame.range = round_outwards(frame.range, 1e-9);
    return out;
  }

  struct VerdictRow {
    double from, to;
    std::string verdict, text;
  };
  std::vector<VerdictRow> verdict_rows() const {
    const EvidenceRows rows(view_.results(), "verdicts");
    std::vector<VerdictRow> out;
    for (size_t row = 0; row < rows.size(); ++row) {
      const auto from = rows.number(row, "from"), to = rows.number(row, "to");
      if (!from || !to) continue;
      const std::string choice = rows.text(row, "choice"), sentence = rows.text(row, "sentence");
      out.push_back({*from, *to, rows.text(row, "verdict"),
                     !sentence.empty() ? sentence : rows.text(row, "verdict") + (choice.empty() ? "" : ": " + choice)});
    }
    return out;
  }

  void add(Figure& figure, const Panel& panel, const Frame& frame, int view) const {
    Chart chart;
    chart.title = panel.title;
    chart.only_view = view;
    ChartView drawn;
    drawn.x = {parameter_.name, parameter_.unit};
    drawn.y = {"tip displacement", "m"};
    draw(panel, frame, drawn.option, chart.height);
    if (!frame_.empty() && below_ > 0)
      drawn.notes.push_back(fmt::format("Over all cases, {} below {} 1/s, outside the panel.",
                                        count_text(static_cast<size_t>(below_), "exponent lies", "exponents lie"),
                                        number_text(frame_.low)));
    if (const size_t rows = lanes(panel).size(); rows > most_lanes)
      drawn.notes.push_back(
          fmt::format("{} starts and methods are too many for a band of regimes here: it stands in the "
                      "views with fewer.",
                      rows));
    if (frame.own) drawn.notes.push_back("Own vertical scale: its points reach far beyond those of the other charts.");
    chart.views.push_back(std::move(drawn));
    for (const CaseRecord* record : panel.cases)
      for (std::string& note : unfinished(*record, panel)) chart.notes.push_back(std::move(note));
    figure.charts.push_back(std::move(chart));
  }

  /// "⊘ refused at 3 values, 0.11 to 0.12: the support passes the stop".
  std::vector<std::string> unfinished(const CaseRecord& record, const Panel& panel) const {
    std::vector<std::pair<std::pair<std::string, std::string>, std::pair<size_t, Interval>>> found;
    for (const Orbit& orbit : orbits_of(record)) {
      if (orbit.done() || (panel.kind && start_kind(orbit.start) != *panel.kind)) continue;
      const std::pair key(orbit.status, orbit.reason);
      auto at = std::find_if(found.begin(), found.end(), [&](const auto& f) { return f.first == key; });
      if (at == found.end()) at = found.insert(found.end(), {key, {0, Interval::nothing()}});
      ++at->second.first;
      at->second.second.include(orbit.parameter);
    }
    const std::string who = panel.cases.size() > 1 ? method_name(record) + ": " : "";
    std::vector<std::string> out;
    if (is_partial(record))
      out.push_back(who + "partial: this case is still being worked on; what it has so far is drawn.");
    for (const auto& [key, what] : found) {
      const auto& [count, range] = what;
      const std::string at = range.low == range.high ? "at " + number_text(range.low, 7)
                                                     : fmt::format("between {} and {}", number_text(range.low, 7),
                                                                   number_text(range.high, 7));
      out.push_back(fmt::format("{} {}{} ({}), {}{}", status_mark(key.first), who, key.first,
                                count_text(count, "orbit", "orbits"), at, key.second.empty() ? "" : ": " + key.second));
    }
    return out;
  }

  struct Lane {
    const CaseRecord* record;
    std::string start, name;
  };
  std::vector<Lane> lanes(const Panel& panel) const {
    std::vector<Lane> out;
    for (const CaseRecord* record : panel.cases)
      for (const std::string& start : starts_in({record}))
        if (!panel.kind || start_kind(start) == *panel.kind)
          out.push_back({record, start, panel.cases.size() > 1 ? method_name(*record) + ", " + start : start});
    return out;
  }

  void draw(const Panel& panel, const Frame& frame, Json& option, int& height) const {
    const std::vector<Lane> rows = lanes(panel);
    const bool exponents = !frame_.empty(), regimes = rows.size() <= most_lanes;
    const std::vector<VerdictRow> said = verdict_rows();
    const bool named = panel.cases.size() == 1;

    option = base_option(Json::array(), Json::array(), false, true);
    option["tooltip"]["formatter"] = "@orbit-tooltip";
    Json grids = Json::array();
    int top = 10;
    const auto grid = [&](int tall, int gap) {
      grids.push_back({{"left", 74}, {"right", 14}, {"top", top}, {"height", tall}});
      top += tall + gap;
      return grids.size() - 1;
    };
    const size_t points = grid(panel.by_method || cases_.size() == 1 ? 380 : 270, 8);
    const size_t growth = exponents ? grid(110, 8) : 0;
    const size_t band = regimes ? grid(std::max(10, static_cast<int>(rows.size()) * (rows.size() > 6 ? 8 : 12)), 6) : 0;
    const size_t verdict = said.empty() ? 0 : grid(12, 6);
    height = top - 6 + 48;

    Json x = Json::array(), y = Json::array();
    for (size_t g = 0; g < grids.size(); ++g) x.push_back(x_axis(g, g + 1 == grids.size()));
    y.push_back(value_axis({"tip displacement", "m"}, frame.range, true));
    Json gutter = {{"type", "value"}, {"min", 0}, {"max", 1}, {"show", false}};
    y.push_back(gutter);
    Json& series = option["series"];
    draw_points(panel, series);
    draw_marks(panel, series);
    if (exponents) {
      Json axis = value_axis({"exponent", "1/s"}, frame_, true);
      axis["gridIndex"] = growth;
      axis["splitNumber"] = 3;
      y.push_back(axis);
      draw_exponents(panel, growth, y.size() - 1, series);
    }
    if (regimes) {
      Json names = Json::array();
      for (const Lane& lane : rows) names.push_back(lane.name);
      y.push_back(band_axis(band, names, named && rows.size() <= 6));
      draw_regimes(rows, band, y.size() - 1, series);
    }
    if (!said.empty()) {
      y.push_back(band_axis(verdict, Json::array({"verdict"}), true));
      draw_verdicts(said, verdict, y.size() - 1, series);
    }
    option["grid"] = std::move(grids);
    Json linked = Json::array();
    for (size_t g = 0; g < x.size(); ++g) linked.push_back(g);
    option["dataZoom"][0]["xAxisIndex"] = std::move(linked);
    option["xAxis"] = std::move(x);
    option["yAxis"] = std::move(y);
    (void)points;
  }

  Json x_axis(size_t grid, bool last) const {
    Interval range = parameters_;
    const bool logarithmic = logarithmic_sweep(range);
    if (!(range.high > range.low)) {
      const double slack = range.low == 0 ? 1 : 0.01 * std::abs(range.low);
      range = {range.low - slack, range.high + slack};
    }
    Json out = logarithmic ? log_axis(parameter_, range, false) : value_axis(parameter_, range, false);
    if (!logarithmic) {
      const double slack = 0.012 * (range.high - range.low);
      out["min"] = range.low - slack;
      out["max"] = range.high + slack;
      // The ends are no round numbers.
      out["axisLabel"]["showMinLabel"] = out["axisLabel"]["showMaxLabel"] = false;
    }
    out["gridIndex"] = grid;
    if (!last) {
      out["axisLabel"]["show"] = false;
      out["name"] = "";
      out["axisTick"]["show"] = false;
    }
    return out;
  }

  static Json band_axis(size_t grid, const Json& names, bool labels) {
    return {{"type", "category"},
            {"gridIndex", grid},
            {"data", names},
            {"inverse", true},
            {"axisLine", {{"show", false}}},
            {"axisTick", {{"show", false}}},
            {"axisLabel", {{"show", labels}, {"interval", 0}, {"fontSize", 10}, {"color", "#5c5c5c"}, {"margin", 6}}}};
  }

  /// Kinds of starts of a panel that a case has with a regime.
  std::vector<size_t> kinds_with(const Panel& panel, const CaseRecord& record, size_t group) const {
    std::vector<size_t> out;
    for (const size_t kind : kinds_)
      if ((!panel.kind || *panel.kind == kind) && has_.contains({record.id, group, kind})) out.push_back(kind);
    return out;
  }

  /// One series per case, regime and kind of start: `make` completes it.
  template <class Make>
  void each(const Panel& panel, Json& series, Make make) const {
    for (const CaseRecord* record : panel.cases)
      for (size_t group = 0; group < regime_groups.size(); ++group)
        for (const size_t kind : kinds_with(panel, *record, group)) {
          Json tags = {regime_groups[group].name, start_kinds[kind].name};
          std::string name = std::string(regime_groups[group].name) + ", " + start_kinds[kind].name;
          if (panel.by_method) {
            tags.push_back(method_name(*record));
            name = method_name(*record) + ": " + name;
          }
          const std::string colour = panel.by_method ? colour_of(*record) : regime_groups[group].colour;
          Json one = {{"name", name},
                      {"tags", tags},
                      {"color", colour},
                      {"itemStyle", {{"color", colour}}},
                      {"data", {{"case", record->id}, {"group", group}, {"kind", kind}}}};
          if (make(one, group, kind)) series.push_back(std::move(one));
        }
  }

  void draw_points(const Panel& panel, Json& series) const {
    each(panel, series, [&](Json& one, size_t group, size_t kind) {
      if (group == failed_group) return false;
      one["type"] = "scatter";
      one["symbol"] = start_kinds[kind].symbol;
      one["progressive"] = 0;
      one["z"] = group <= 6 ? 3 : 2;
      one["data"]["sweep"] = "points";
      return true;
    });
  }

  void draw_exponents(const Panel& panel, size_t grid, size_t axis, Json& series) const {
    const auto place = [&](Json& one) {
      one["xAxisIndex"] = grid;
      one["yAxisIndex"] = axis;
    };
    Json zero = {{"type", "line"},
                 {"name", "zero"},
                 {"symbol", "none"},
                 {"silent", true},
                 {"z", 1},
                 {"color", faint},
                 {"lineStyle", {{"color", "#555555"}, {"width", 1}, {"type", "solid"}}},
                 {"data", {{"sweep", "zero"}}}};
    place(zero);
    series.push_back(std::move(zero));
    for (const char* what : {"whiskers", "exponents"})
      each(panel, series, [&](Json& one, size_t group, size_t kind) {
        if (group == failed_group) return false;
        place(one);
        one["data"]["sweep"] = what;
        one["data"]["index"] = 1;
        if (std::string_view(what) == "whiskers") {
          one["type"] = "line";
          one["symbol"] = "none";
          one["silent"] = true;
          one["z"] = 2;
          one["lineStyle"] = {{"color", lighten(one["color"].get<std::string>(), 0.35)}, {"width", 1}};
        } else {
          one["type"] = "scatter";
          one["symbol"] = start_kinds[kind].symbol;
          one["symbolSize"] = 4;
          one["z"] = 3;
        }
        return true;
      });
    for (size_t k = 2; k <= most_exponents_; ++k)
      each(panel, series, [&](Json& one, size_t group, size_t) {
        if (group == failed_group) return false;
        place(one);
        one["tags"].push_back("further exponents");
        one["name"] = one["name"].get<std::string>() + fmt::format(", exponent {}", k);
        one["type"] = "scatter";
        one["symbol"] = "circle";
        one["symbolSize"] = 3;
        one["z"] = 2;
        one["itemStyle"]["color"] = lighten(one["color"].get<std::string>(), 0.45);
        one["data"]["sweep"] = "exponents";
        one["data"]["index"] = k;
        return true;
      });
    if (!twins_) return;
    each(panel, series, [&](Json& one, size_t group, size_t) {
      if (group == failed_group) return false;
      place(one);
      one["tags"].push_back("twin check");
      one["name"] = one["name"].get<std::string>() + ", twin";
      one["type"] = "scatter";
      one["symbol"] = "path://M0,0L10,10M10,0L0,10";
      one["symbolSize"] = 5;
      one["z"] = 2;
      one["itemStyle"] = {{"color", "none"}, {"borderColor", "#8a8a8a"}, {"borderWidth", 1}};
      one["data"]["sweep"] = "twins";
      return true;
    });
  }

  /// Cells of one colour in a band under the diagram; `data` gives their ends along x and their row.
  static Json band_series(const std::string& name, const char* tag, const char* colour, size_t grid, size_t axis,
                          Json data) {
    return {{"type", "custom"},
            {"name", name},
            {"tags", Json::array({tag})},
            {"xAxisIndex", grid},
            {"yAxisIndex", axis},
            {"renderItem", "@cell"},
            {"encode", {{"x", {0, 1}}, {"y", 2}}},
            {"clip", true},
            {"progressive", 0},
            {"itemStyle", {{"color", colour}}},
            {"data", std::move(data)}};
  }

  void draw_regimes(const std::vector<Lane>& rows, size_t grid, size_t axis, Json& series) const {
    Json list = Json::array();
    std::set<size_t> present;
    for (const Lane& lane : rows) {
      list.push_back({lane.record->id, lane.start});
      for (size_t group = 0; group < regime_groups.size(); ++group)
        if (has_.contains({lane.record->id, group, start_kind(lane.start)})) present.insert(group);
    }
    for (const size_t group : present)
      series.push_back(band_series(std::string("regime ") + regime_groups[group].name, regime_groups[group].name,
                                   regime_groups[group].colour, grid, axis,
                                   {{"sweep", "cells"}, {"lanes", list}, {"group", group}}));
  }

  static void draw_verdicts(const std::vector<VerdictRow>& rows, size_t grid, size_t axis, Json& series) {
    for (const Verdict& verdict : verdicts) {
      Json data = Json::array();
      for (const VerdictRow& row : rows)
        if (row.verdict == verdict.word) data.push_back({{"value", {row.from, row.to, 0}}, {"text", row.text}});
      if (data.empty()) continue;
      series.push_back(band_series(verdict.word, verdict.word, verdict.colour, grid, axis, std::move(data)));
    }
  }

  /// What did not finish, on the axis; located changes, along the upper edge.
  void draw_marks(const Panel& panel, Json& series) const {
    for (const CaseRecord* record : panel.cases) {
      if (!kinds_with(panel, *record, failed_group).empty()) {
        Json marks = mark_series("not finished", ink, Json::array());
        marks["tags"] = {regime_groups[failed_group].name};
        if (panel.by_method) marks["tags"].push_back(method_name(*record));
        marks["yAxisIndex"] = 1;
        marks["label"]["fontSize"] = 11;
        marks["data"] = {{"sweep", "marks"}, {"case", record->id}};
        if (panel.kind) marks["data"]["kind"] = *panel.kind;
        series.push_back(std::move(marks));
      }
      const Table* table = find_table(record->tables, "bifurcations");
      if (!table) continue;
      Json data = Json::array();
      for (const Change& change : changes(*table)) {
        if (panel.kind && start_kind(change.start) != *panel.kind) continue;
        data.push_back({{"value", {change.value, 0.97}}, {"text", change.text}});
      }
      if (data.empty()) continue;
      const std::string colour = panel.by_method ? colour_of(*record) : ink;
      Json one = {{"type", "scatter"},
                  {"name", panel.by_method ? "located change, " + method_name(*record) : "located change"},
                  {"tags", Json::array({"located change"})},
                  {"symbol", "triangle-down"},
                  {"symbolSize", 7},
                  {"z", 5},
                  {"yAxisIndex", 1},
                  {"color", colour},
                  {"itemStyle", {{"color", colour}}},
                  {"data", std::move(data)}};
      if (panel.by_method) one["tags"].push_back(method_name(*record));
      series.push_back(std::move(one));
    }
  }

  struct Change {
    double value;
    std::string start, text;
  };
  static std::vector<Change> changes(const Table& table) {
    std::vector<Change> out;
    const TableReader rows(table);
    for (size_t row = 0; row < rows.size(); ++row) {
      const auto value = rows.number(row, "value"), low = rows.number(row, "low"), high = rows.number(row, "high");
      if (!value) continue;
      std::string said = fmt::format("{}: {} → {}, start {}", rows.text(row, "kind"), rows.text(row, "from"),
                                     rows.text(row, "to"), rows.text(row, "start"));
      if (low && high) said += fmt::format(", between {} and {}", exact_text(*low), exact_text(*high));
      out.push_back({*value, rows.text(row, "start"), said});
    }
    return out;
  }

  void add_legend(Figure& figure) const {
    for (const size_t group : groups_)
      figure.legend.push_back({regime_groups[group].name, regime_groups[group].colour, "0 30", "rect", "Regime"});
    if (kinds_.size() > 1)
      for (const size_t kind : kinds_)
        figure.legend.push_back({start_kinds[kind].name, "#555555", "0 30", start_kinds[kind].symbol, "Start"});
    if (cases_.size() > 1)
      for (const CaseRecord* record : cases_)
        figure.legend.push_back({method_name(*record), colour_of(*record), "0 30", "roundRect", "Method (overlaid)"});
    const auto used = [&](const std::string& tag) {
      for (const Chart& chart : figure.charts)
        for (const Json& series : chart.views.front().option["series"])
          if (series.contains("tags"))
            for (const Json& one : series["tags"])
              if (one == tag) return true;
      return false;
    };
    for (const Verdict& verdict : verdicts)
      if (used(verdict.word)) figure.legend.push_back({verdict.word, verdict.colour, "0 30", "rect", "Verdict"});
    if (used("located change")) figure.legend.push_back({"located change", ink, "0 30", "triangle-down", "Marks"});
    if (used("further exponents")) figure.legend.push_back({"further exponents", faint, "0 30", "circle", "Marks"});
    if (used("twin check")) figure.legend.push_back({"twin check", ink, "0 30", "cross", "Marks"});
  }

  const CaseView& view_;
  Quantity parameter_;
  Cases cases_;
  Interval parameters_ = Interval::nothing(), frame_ = Interval::nothing();
  std::map<std::string, Interval> heights_;
  std::set<size_t> kinds_, groups_;
  std::set<std::tuple<std::string, size_t, size_t>> has_;
  std::map<std::string, size_t> methods_;
  size_t most_exponents_ = 0, marginal_ = 0;
  std::ptrdiff_t below_ = 0;
  bool twins_ = false;
};

}  // namespace

std::vector<Figure> diagram_figures(const CaseView& view, CurveData& curves) {
  const Diagram diagram(view);
  if (view.results().kind != "bifurcation" || diagram.empty()) return {};
  std::vector<Figure> out;
  out.push_back(diagram.make(curves));
  return out;
}

}  // namespace ricochet::report
