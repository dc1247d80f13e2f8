#include <fmt/format.h>

#include <algorithm>

#include "runners/report/basins.hpp"
#include "runners/report/dynamics_report.hpp"
#include "runners/report/html.hpp"
#include "runners/report/options.hpp"
#include "runners/report/orbits.hpp"

namespace ricochet::report {
namespace {

constexpr const char* differs_colour = "#C2410C";
constexpr const char* same_colour = "#CFE3F2";
constexpr const char* unknown_colour = "#DADADA";

/// Half a cell beyond the outer values.
Interval bounds(const std::vector<double>& values) {
  const size_t n = values.size();
  if (n < 2) return {values.front() - 0.5, values.front() + 0.5};
  return {values[0] - 0.5 * (values[1] - values[0]), values[n - 1] + 0.5 * (values[n - 1] - values[n - 2])};
}

class BasinImages {
 public:
  BasinImages(const CaseView& view, const Basins& basins, CurveData& curves) : view_(view), basins_(basins) {
    for (const BasinGrid& grid : basins.grids) curves.put(grid.record->id + "/cells", "u8", grid.cells);
    Json labels = Json::array(), grids = Json::array();
    for (const BasinLabel& label : basins.labels) labels.push_back({label.name, label.colour});
    for (const BasinGrid& grid : basins.grids) grids.push_back({grid.record->id, name(grid)});
    cells_ = {{"study", view.results().study.value("name", "")},
              {"xs", basins.xs},
              {"ys", basins.ys},
              {"labels", std::move(labels)},
              {"grids", std::move(grids)}};
  }

  Figure make() const {
    Figure figure{"basins", "Basins of attraction", "", {"basins"}, {}, {}, false};
    figure.linked = true;
    const bool compares = basins_.grids.size() > 1;
    if (compares) figure.views.push_back("difference");
    figure.caption =
        fmt::format("{} × {} cells: the attractor that each ends in.", basins_.xs.size(), basins_.ys.size());
    if (compares)
      figure.caption += fmt::format(" Difference: cells that end elsewhere than with {}.", name(basins_.grids.front()));
    figure.caption += " White: not known yet. Click a cell for the command that marches it.";
    for (const BasinGrid& grid : basins_.grids) {
      Chart chart;
      chart.title = name(grid) + (is_partial(*grid.record) ? " (partial)" : "");
      chart.height = 420;
      chart.views.push_back(labels_view(grid));
      if (compares) chart.views.push_back(difference_view(grid));
      if (grid.filled > 0)
        chart.notes.push_back(
            fmt::format("{} of {} cells take the end of a marched one of their basin: only boundaries "
                        "were marched cell by cell.",
                        grid.filled, grid.cells.size()));
      for (const auto& [reason, count] : grid.reasons)
        chart.notes.push_back(fmt::format("{} {}{}", status_mark("failed"),
                                          count_text(count, "cell failed", "cells failed"),
                                          reason.empty() ? "" : ": " + reason));
      figure.charts.push_back(std::move(chart));
    }
    for (const BasinLabel& label : basins_.labels)
      figure.legend.push_back({label.name, label.colour, "0 30", "rect", "Ends in"});
    if (compares) {
      figure.legend.push_back({"differs", differs_colour, "0 30", "rect", "Difference"});
      figure.legend.push_back({"the same", same_colour, "0 30", "rect", "Difference"});
      figure.legend.push_back({"not decided", unknown_colour, "0 30", "rect", "Difference"});
    }
    return figure;
  }

 private:
  std::string name(const BasinGrid& grid) const {
    const std::string label = view_.label(*grid.record);
    return label.empty() ? "all cases" : label;
  }

  ChartView frame() const {
    ChartView out;
    out.x = basins_.x;
    out.y = basins_.y;
    const Interval x = bounds(basins_.xs), y = bounds(basins_.ys);
    Json across = value_axis(out.x, x, false), up = value_axis(out.y, y, true);
    for (Json* axis : {&across, &up}) {
      (*axis)["splitLine"] = {{"show", false}};
      // Half a cell beyond the outer values: no numbers to read.
      (*axis)["axisLabel"]["showMinLabel"] = (*axis)["axisLabel"]["showMaxLabel"] = false;
    }
    out.option = base_option(std::move(across), std::move(up), false, true);
    out.option["tooltip"]["formatter"] = "@cell-tooltip";
    out.option["cells"] = cells_;
    return out;
  }

  Json image(const std::string& series, const std::string& colour, Json reference) const {
    const Interval x = bounds(basins_.xs), y = bounds(basins_.ys);
    reference["sweep"] = "image";
    reference["columns"] = basins_.xs.size();
    reference["rows"] = basins_.ys.size();
    reference["colour"] = colour;
    reference["bounds"] = {x.low, x.high, y.low, y.high};
    return {{"type", "custom"},
            {"name", series},
            {"tags", Json::array({series})},
            {"renderItem", "@image"},
            {"encode", {{"x", {0, 1}}, {"y", {2, 3}}}},
            {"clip", true},
            {"progressive", 0},
            {"color", colour},
            {"itemStyle", {{"color", colour}}},
            {"data", std::move(reference)}};
  }

  ChartView labels_view(const BasinGrid& grid) const {
    ChartView out = frame();
    for (size_t k = 0; k < basins_.labels.size(); ++k)
      if (std::find(grid.cells.begin(), grid.cells.end(), k) != grid.cells.end())
        out.option["series"].push_back(
            image(basins_.labels[k].name, basins_.labels[k].colour, {{"case", grid.record->id}, {"label", k}}));
    return out;
  }

  ChartView difference_view(const BasinGrid& grid) const {
    const BasinGrid& first = basins_.grids.front();
    ChartView out = frame();
    size_t counts[3] = {0, 0, 0};
    const auto decided = [&](std::uint8_t cell) { return cell != BasinGrid::absent && basins_.labels[cell].decided; };
    for (size_t i = 0; i < grid.cells.size(); ++i)
      ++counts[!decided(grid.cells[i]) || !decided(first.cells[i]) ? 2 : grid.cells[i] == first.cells[i] ? 1 : 0];
    Json undecided = Json::array();
    for (size_t k = 0; k < basins_.labels.size(); ++k)
      if (!basins_.labels[k].decided) undecided.push_back(k);
    const std::pair<const char*, const char*> kinds[] = {
        {"differs", differs_colour}, {"the same", same_colour}, {"not decided", unknown_colour}};
    for (int k = 0; k < 3; ++k)
      if (counts[k] > 0)
        out.option["series"].push_back(
            image(kinds[k].first, kinds[k].second,
                  {{"case", grid.record->id}, {"other", first.record->id}, {"differs", k}, {"undecided", undecided}}));
    const size_t both = counts[0] + counts[1];
    if (&grid == &first)
      out.notes.push_back("This is what the others are compared with.");
    else
      out.notes.push_back(fmt::format(
          "{} of {} cells that both decide differ{}.", counts[0], both,
          both > 0 ? " (" + share_text(static_cast<double>(counts[0]) / static_cast<double>(both)) + ")" : ""));
    return out;
  }

  const CaseView& view_;
  const Basins& basins_;
  Json cells_;  // what a cell is, for tooltips and clicks: axes, labels, cases
};

}  // namespace

std::vector<Figure> basin_figures(const CaseView& view, CurveData& curves) {
  const Basins basins = basins_of(view.results());
  if (basins.grids.empty()) return {};
  std::vector<Figure> out;
  out.push_back(BasinImages(view, basins, curves).make());
  return out;
}

}  // namespace ricochet::report
