#include "runners/report/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

struct Dash {
  const char* echarts;
  const char* svg;
};
constexpr Dash dashes[] = {{"\"solid\"", ""},        {"[7,4]", "7 4"},   {"[2,3]", "2 3"},
                           {"[9,3,2,3]", "9 3 2 3"}, {"[14,5]", "14 5"}, {"[9,3,2,3,2,3]", "9 3 2 3 2 3"}};
constexpr const char* symbols[] = {"circle", "rect", "triangle", "diamond", "roundRect", "arrow"};

constexpr const char* ink = "#333333";
constexpr const char* faint = "#9a9a9a";

Json axis(const Quantity& quantity, bool vertical) {
  Json out = {{"name", with_unit(quantity)},
              {"nameLocation", "middle"},
              {"nameGap", vertical ? 52 : 26},
              {"nameTextStyle", {{"color", ink}, {"fontSize", 11}}},
              {"axisLine", {{"show", true}, {"lineStyle", {{"color", faint}}}, {"onZero", false}}},
              {"axisTick", {{"show", true}, {"lineStyle", {{"color", faint}}}}},
              {"splitLine", {{"show", true}, {"lineStyle", {{"color", "#ececec"}}}}},
              {"axisLabel", {{"color", ink}, {"fontSize", 11}, {"hideOverlap", true}}},
              {"axisPointer", {{"label", {{"show", false}}}}}};
  return out;
}

}  // namespace

void Interval::include(double value) {
  if (!std::isfinite(value)) return;
  if (empty())
    low = high = value;
  else
    low = std::min(low, value), high = std::max(high, value);
}

void Interval::include(const Interval& other) {
  if (other.empty()) return;
  include(other.low);
  include(other.high);
}

Interval round_outwards(Interval interval, double least) {
  if (interval.high - interval.low < least) {
    const double middle = 0.5 * (interval.low + interval.high);
    interval = {middle - 0.5 * least, middle + 0.5 * least};
  }
  const double raw = (interval.high - interval.low) / 5, decade = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * decade;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * decade >= raw) step = factor * decade;
  return {step * std::floor(interval.low / step + 1e-9), step * std::ceil(interval.high / step - 1e-9)};
}

Interval whole_decades(Interval interval) {
  double low = std::floor(std::log10(interval.low) + 1e-9), high = std::ceil(std::log10(interval.high) - 1e-9);
  if (high <= low) high = low + 1;
  return {std::pow(10, low), std::pow(10, high)};
}

std::vector<Frame> shared_frames(const std::vector<Interval>& ranges) {
  const auto magnitude = [](const Interval& r) { return std::max(std::abs(r.low), std::abs(r.high)); };
  std::vector<double> sizes;
  for (const Interval& range : ranges)
    if (!range.empty()) sizes.push_back(magnitude(range));
  std::sort(sizes.begin(), sizes.end());
  const double usual = sizes.empty() ? 0 : sizes[(sizes.size() - 1) / 2];
  Interval shared = Interval::nothing();
  for (const Interval& range : ranges)
    if (!range.empty() && magnitude(range) <= 4 * usual) shared.include(range);
  std::vector<Frame> out;
  for (const Interval& range : ranges) {
    const bool own = !range.empty() && magnitude(range) > 4 * usual;
    out.push_back({own ? range : shared, own});
  }
  return out;
}

Json line_dash(size_t k) {
  return Json::parse(dashes[k % std::size(dashes)].echarts);
}
std::string svg_dash(size_t k) {
  return dashes[k % std::size(dashes)].svg;
}
size_t dash_count() {
  return std::size(dashes);
}
std::string symbol(size_t k) {
  return symbols[k % std::size(symbols)];
}

std::string lighten(const std::string& colour, double share) {
  std::string out = "#";
  for (int k = 0; k < 3; ++k) {
    const int value = std::stoi(colour.substr(static_cast<size_t>(1 + 2 * k), 2), nullptr, 16);
    out += fmt::format("{:02X}", static_cast<int>(std::lround(value + share * (255 - value))));
  }
  return out;
}

std::string status_mark(const std::string& status) {
  if (status == "done") return "✓";
  if (status == "refused") return "⊘";
  if (status == "diverged") return "✕";
  if (status == "failed") return "!";
  return "?";
}

Json value_axis(const Quantity& quantity, const Interval& range, bool vertical) {
  Json out = axis(quantity, vertical);
  out["type"] = "value";
  out["axisLabel"]["formatter"] = "@number";
  if (!range.empty()) {
    out["min"] = range.low;
    out["max"] = range.high;
  }
  out["scale"] = true;
  return out;
}

Json log_axis(const Quantity& quantity, const Interval& range, bool vertical) {
  Json out = axis(quantity, vertical);
  out["type"] = "log";
  out["axisLabel"]["formatter"] = "@power";
  const Interval decades = whole_decades(range);
  out["min"] = decades.low;
  out["max"] = decades.high;
  if (std::log10(decades.high / decades.low) < 6.5) {
    out["minorTick"] = {{"show", true}, {"splitNumber", 9}, {"length", 2}};
    out["minorSplitLine"] = {{"show", false}};
  }
  return out;
}

Json base_option(Json x, Json y, bool along_x, bool hover_items) {
  Json out = {{"animation", false},
              {"backgroundColor", "#ffffff"},
              {"textStyle",
               {{"fontFamily", "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"}}},
              {"grid", {{"left", 70}, {"right", 18}, {"top", 14}, {"bottom", 44}}},
              {"legend", {{"show", false}}}};
  out["tooltip"] = {{"trigger", hover_items ? "item" : "axis"},
                    {"confine", true},
                    {"transitionDuration", 0},
                    {"formatter", "@tooltip"},
                    {"textStyle", {{"fontSize", 12}, {"color", ink}}}};
  if (!hover_items) out["tooltip"]["axisPointer"] = {{"type", "line"}, {"lineStyle", {{"color", faint}}}};
  // Points outside the window are left out along x, so that zooming in shows every sample; never along y, where that
  // would cut curves.
  out["dataZoom"] = {{{"type", "inside"},
                      {"id", "along-x"},
                      {"xAxisIndex", 0},
                      {"filterMode", along_x ? "filter" : "none"},
                      {"zoomOnMouseWheel", "shift"},
                      {"moveOnMouseMove", "shift"},
                      {"moveOnMouseWheel", false}},
                     {{"type", "inside"},
                      {"id", "along-y"},
                      {"yAxisIndex", 0},
                      {"filterMode", "none"},
                      {"zoomOnMouseWheel", "alt"},
                      {"moveOnMouseMove", false},
                      {"moveOnMouseWheel", false}}};
  out["xAxis"] = std::move(x);
  out["yAxis"] = std::move(y);
  out["series"] = Json::array();
  return out;
}

Json mark_series(const std::string& name, const std::string& colour, Json items) {
  for (Json& item : items) item["label"] = {{"formatter", item["mark"]}};
  return {
      {"type", "scatter"},
      {"name", name},
      {"symbol", "circle"},
      {"symbolSize", 15},
      {"z", 5},
      {"itemStyle", {{"color", "rgba(255,255,255,0.7)"}}},
      {"label", {{"show", true}, {"position", "inside"}, {"color", colour}, {"fontSize", 14}, {"fontWeight", "bold"}}},
      {"data", std::move(items)}};
}

std::vector<std::string> outcome_notes(const CaseView& view, const Cases& cases,
                                       const std::vector<std::string>& columns) {
  std::vector<std::pair<std::pair<std::string, std::string>, Cases>> groups;
  for (const CaseRecord* record : cases) {
    if (record->status == "done") continue;
    const std::pair key(record->status, record->reason);
    auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == key; });
    if (found == groups.end()) found = groups.insert(groups.end(), {key, {}});
    found->second.push_back(record);
  }
  std::vector<std::string> out;
  for (const auto& [key, group] : groups) {
    std::string who;
    if (group.size() > 2) {
      who = view.describe(group, cases);
    } else {
      for (const CaseRecord* record : group) who += (who.empty() ? "" : "; ") + view.label(*record, columns);
    }
    out.push_back(status_mark(key.first) + " " + key.first + (who.empty() ? "" : ", " + who) +
                  (key.second.empty() ? "" : ": " + key.second));
  }
  return out;
}

}  // namespace ricochet::report
