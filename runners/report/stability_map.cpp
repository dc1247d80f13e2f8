#include "runners/report/stability_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/report/html.hpp"
#include "runners/report/options.hpp"
#include "runners/report/stability_rows.hpp"

namespace ricochet::report {
namespace {

constexpr const char* stable_colour = "#D6E6F4";
constexpr const char* marginal_colour = "#F6EBB0";
constexpr const char* unstable_colour = "#D55E00";
constexpr const char* refused_colour = "#E3E3E3";
constexpr const char* ink = "#222222";
constexpr const char* predicted_colour = "#0072B2";
constexpr size_t most_notes = 6;

/// One value of the parameter: its place on the axis, and the band that it owns.
struct Band {
  double value = 0, low = 0, high = 0;
  StabilityRange range;
};

/// Bands of neighbouring values meet half-way.
void share_axis(std::vector<Band>& bands, bool logarithmic) {
  const auto to = [&](double v) { return logarithmic ? std::log(v) : v; };
  const auto from = [&](double v) { return logarithmic ? std::exp(v) : v; };
  const size_t n = bands.size();
  for (size_t i = 0; i < n; ++i) {
    const double here = to(bands[i].value);
    const double below = i > 0 ? to(bands[i - 1].value) : 2 * here - to(bands[std::min(i + 1, n - 1)].value);
    const double above = i + 1 < n ? to(bands[i + 1].value) : 2 * here - to(bands[i > 0 ? i - 1 : 0].value);
    bands[i].low = from(0.5 * (below + here));
    bands[i].high = from(0.5 * (here + above));
  }
}

/// Edges of the steps of a range, half-way on the logarithmic scale.
std::vector<double> edges(const std::vector<StabilityCell>& cells) {
  std::vector<double> out;
  const size_t n = cells.size();
  const double ratio = n > 1 ? std::sqrt(cells[1].step / cells[0].step) : 1.5;
  out.push_back(cells.front().step / ratio);
  for (size_t i = 0; i + 1 < n; ++i) out.push_back(std::sqrt(cells[i].step * cells[i + 1].step));
  out.push_back(n > 1 ? cells.back().step * std::sqrt(cells[n - 1].step / cells[n - 2].step) : cells[0].step * ratio);
  return out;
}

std::string background_of(const StabilityCell& cell) {
  if (cell.predicted_unstable()) return "predicted unstable";
  if (!cell.worst) return "not predicted";
  return cell.marginal.empty() ? "predicted stable" : "predicted marginal";
}

/// Darker the faster it grows: 1e-6 per step pale, tenfold per step full.
std::string unstable_shade(double radius) {
  const double decades = std::clamp((std::log10(radius - 1) + 6) / 7, 0.0, 1.0);
  return lighten(unstable_colour, 0.75 - 0.6 * decades);
}

class Map {
 public:
  Map(const CaseView& view, std::string column) : view_(view), column_(std::move(column)) {
    for (const CaseRecord* record : view_.all())
      if (const auto value = CaseView::number(*record, column_)) values_.include(*value);
    logarithmic_ = values_.low > 0 && values_.high >= 9 * values_.low;
  }

  std::optional<Figure> make() const {
    std::string slug = column_;
    std::replace(slug.begin(), slug.end(), '.', '-');
    Figure figure{
        "stability-map-" + slug,
        "Stability over step and " + column_,
        "Background: what one step's spectrum predicts, darker the faster it grows. Marks: what marching "
        "showed. Closed contact is predicted with points held on both sides and observed in the scene itself, "
        "which is open as well: its background is the worse of both.",
        {"map"},
        {},
        {},
        false};
    // The law plays no part while nothing touches.
    for (const bool closed : {false, true})
      if (closed || role_of(column_) != "contact") add_charts(figure, closed);
    if (figure.charts.empty()) return std::nullopt;
    for (const auto& [name, colour] :
         std::vector<std::pair<std::string, std::string>>{{"predicted stable", stable_colour},
                                                          {"predicted marginal", marginal_colour},
                                                          {"predicted unstable", lighten(unstable_colour, 0.4)},
                                                          {"not predicted", refused_colour}})
      if (used(figure, name)) figure.legend.push_back({name, colour, "", "rect"});
    for (const auto& [name, mark] : std::vector<std::pair<std::string, std::string>>{{"observed stable", "circle"},
                                                                                     {"observed unstable", "diamond"}})
      if (used(figure, name))
        figure.legend.push_back({name, name == "observed stable" ? "#5a5a5a" : ink, "0 30", mark});
    if (used(figure, "predicted limit")) figure.legend.push_back({"predicted limit", predicted_colour, "", ""});
    if (used(figure, "observed limit")) figure.legend.push_back({"observed limit", ink, svg_dash(1), ""});
    return figure;
  }

 private:
  static bool used(const Figure& figure, const std::string& name) {
    for (const Chart& chart : figure.charts)
      for (const ChartView& view : chart.views)
        for (const Json& series : view.option["series"])
          if (series["name"] == name) return true;
    return false;
  }

  void add_charts(Figure& figure, bool closed) const {
    Cases cases = stability_cases(view_, closed);
    std::erase_if(cases, [&](const CaseRecord* record) { return !CaseView::number(*record, column_); });
    std::vector<std::string> others = closed ? view_.varying() : view_.varying_without({"contact"});
    std::erase(others, column_);
    for (const CaseGroup& facet : view_.group(cases, others)) {
      std::map<double, StabilityRange> by_value;
      for (const CaseRecord* record : facet.cases)
        by_value.emplace(*CaseView::number(*record, column_), *stability_range(*record, closed));
      if (by_value.size() < 2) continue;
      std::vector<Band> bands;
      for (auto& [value, range] : by_value) bands.push_back({value, 0, 0, std::move(range)});
      share_axis(bands, logarithmic_);
      Chart chart;
      chart.title = (closed ? "closed" : "open") + (facet.label.empty() ? "" : " · " + facet.label);
      chart.views.push_back(draw(bands));
      chart.notes = notes(bands);
      figure.charts.push_back(std::move(chart));
    }
  }

  ChartView draw(const std::vector<Band>& bands) const {
    ChartView out;
    out.x = {"step h", "s"};
    const std::string unit = axis_unit(column_);
    out.y = {column_, unit.empty() ? "1" : unit};
    Interval x = Interval::nothing(), y = Interval::nothing();
    for (const Band& band : bands) {
      const std::vector<double> at = edges(band.range.cells);
      x.include(Interval{at.front(), at.back()});
      y.include(Interval{band.low, band.high});
    }
    Json along = frame(log_axis(out.x, x, false), x);
    Json up = frame(logarithmic_ ? log_axis(out.y, y, true) : value_axis(out.y, y, true), y);
    out.option = base_option(std::move(along), std::move(up), false, true);
    draw_background(bands, x, y, out);
    draw_limits(bands, out);
    draw_marks(bands, out);
    return out;
  }

  /// The axis ends with the outer cells; over many decades, where labels need whole ones, with the next decade.
  static Json frame(Json axis, Interval& range) {
    axis["splitLine"] = {{"show", false}};
    const bool many = axis["type"] == "log" && range.high > 1e9 * range.low;
    if (many) {
      range = whole_decades(range);
      axis["interval"] = std::ceil(std::log10(range.high / range.low) / 6);
    } else {
      // Half a cell beyond the outer values: no numbers to read.
      axis["axisLabel"]["showMinLabel"] = axis["axisLabel"]["showMaxLabel"] = false;
    }
    axis["min"] = range.low;
    axis["max"] = range.high;
    return axis;
  }

  static void draw_background(const std::vector<Band>& bands, const Interval& x, const Interval& y, ChartView& out) {
    std::map<std::string, Json> areas;
    for (const Band& band : bands) {
      std::vector<double> at = edges(band.range.cells);
      at.front() = std::min(at.front(), x.low);
      at.back() = std::max(at.back(), x.high);
      const double low = &band == &bands.front() ? y.low : band.low, high = &band == &bands.back() ? y.high : band.high;
      for (size_t i = 0; i < band.range.cells.size(); ++i) {
        const StabilityCell& cell = band.range.cells[i];
        const std::string name = background_of(cell);
        const std::string colour = name == "predicted unstable"   ? unstable_shade(*cell.worst)
                                   : name == "predicted stable"   ? stable_colour
                                   : name == "predicted marginal" ? marginal_colour
                                                                  : refused_colour;
        areas[name].push_back(Json::array(
            {{{"coord", {at[i], low}}, {"itemStyle", {{"color", colour}}}}, {{"coord", {at[i + 1], high}}}}));
      }
    }
    for (auto& [name, data] : areas)
      out.option["series"].push_back({{"type", "line"},
                                      {"name", name},
                                      {"symbol", "none"},
                                      {"color", name == "predicted stable"     ? stable_colour
                                                : name == "predicted marginal" ? marginal_colour
                                                : name == "predicted unstable" ? unstable_colour
                                                                               : refused_colour},
                                      {"data", Json::array()},
                                      {"markArea",
                                       {{"silent", true},
                                        {"z", 0},
                                        {"label", {{"show", false}}},
                                        {"animation", false},
                                        {"itemStyle", {{"opacity", 1}, {"borderWidth", 0}}},
                                        {"data", std::move(data)}}}});
  }

  static void draw_limits(const std::vector<Band>& bands, ChartView& out) {
    for (const bool observed : {false, true}) {
      Json data = Json::array();
      bool any = false;
      for (const Band& band : bands) {
        const auto& limit = observed ? band.range.observed : band.range.expected;
        any = any || limit.has_value();
        if (!limit) {
          data.push_back({{"value", {"-", "-"}}});
          continue;
        }
        // A boundary is a line across the band of its value.
        const std::string text =
            fmt::format("{} limit h = {} s", observed ? "observed" : "predicted", number_text(*limit, 5));
        for (const double at : {band.low, band.value, band.high})
          data.push_back({{"value", {*limit, at}}, {"text", text}});
      }
      if (!any) continue;
      const char* colour = observed ? ink : predicted_colour;
      out.option["series"].push_back(
          {{"type", "line"},
           {"name", observed ? "observed limit" : "predicted limit"},
           {"symbol", "none"},
           {"z", 4},
           {"color", colour},
           {"lineStyle", {{"color", colour}, {"width", observed ? 1.8 : 4}, {"type", line_dash(observed ? 1 : 0)}}},
           {"data", std::move(data)}});
    }
  }

  static void draw_marks(const std::vector<Band>& bands, ChartView& out) {
    Json stable = Json::array(), unstable = Json::array(), unseen = Json::array();
    for (const Band& band : bands)
      for (const StabilityCell& cell : band.range.cells) {
        Json item = {{"value", {cell.step, band.value}}, {"text", cell_text(cell)}};
        (cell.behaviour.empty() ? unseen : cell.observed_unstable() ? unstable : stable).push_back(std::move(item));
      }
    const auto add = [&](const char* name, const char* shape, double size, const char* colour, Json data) {
      if (data.empty()) return;
      out.option["series"].push_back({{"type", "scatter"},
                                      {"name", name},
                                      {"symbol", shape},
                                      {"symbolSize", size},
                                      {"z", 5},
                                      {"color", colour},
                                      {"itemStyle", {{"color", colour}}},
                                      {"data", std::move(data)}});
    };
    add("observed stable", "circle", 4, "#5a5a5a", std::move(stable));
    add("observed unstable", "diamond", 8, ink, std::move(unstable));
    // Cells that were not marched still tell what is predicted when pointed at.
    add("prediction", "circle", 8, "rgba(0,0,0,0)", std::move(unseen));
  }

  static std::string cell_text(const StabilityCell& cell) {
    std::string out = background_of(cell);
    if (cell.worst) out += fmt::format(", radius {}", number_text(*cell.worst, 6));
    if (!cell.behaviour.empty()) out += ", observed " + cell.behaviour;
    for (const std::string& more : {cell.marginal, cell.reason})
      if (!more.empty()) out += "; " + more;
    return out;
  }

  std::vector<std::string> notes(const std::vector<Band>& bands) const {
    std::vector<std::string> out;
    for (const Band& band : bands)
      for (const std::string& text : disagreements(band.range))
        out.push_back(fmt::format("{} {}: {}", column_, exact_text(band.value), text));
    if (out.size() > most_notes) {
      const size_t more = out.size() - most_notes;
      out.resize(most_notes);
      out.push_back(fmt::format("and {} more", count_text(more, "range of disagreement", "ranges of disagreement")));
    }
    std::vector<std::string> refusals;
    for (const Band& band : bands)
      for (const StabilityCell& cell : band.range.cells)
        if (cell.status == "refused" || cell.status == "failed")
          if (std::find(refusals.begin(), refusals.end(), cell.reason) == refusals.end())
            refusals.push_back(cell.reason);
    for (const std::string& reason : refusals) out.push_back("⊘ " + reason);
    return out;
  }

  const CaseView& view_;
  std::string column_;
  Interval values_ = Interval::nothing();
  bool logarithmic_ = false;
};

}  // namespace

std::vector<Figure> stability_maps(const CaseView& view) {
  std::vector<Figure> out;
  for (const std::string& column : view.varying()) {
    size_t numbers = 0;
    for (const std::string& value : view.values(column)) {
      char* end = nullptr;
      std::strtod(value.c_str(), &end);
      numbers += end != value.c_str() && *end == 0;
    }
    if (numbers < 3) continue;
    if (auto figure = Map(view, column).make()) out.push_back(std::move(*figure));
  }
  return out;
}

}  // namespace ricochet::report
