#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"

namespace ricochet::report {

using Json = nlohmann::ordered_json;

/// One way to look at a chart's data (joules, ratio to the start, …).
struct ChartView {
  Json option;                     ///< an ECharts option; data given as references into CurveData, functions as "@name"
  Quantity x, y;                   ///< what the tooltip says
  std::vector<std::string> notes;  ///< said below the chart: what a logarithmic axis cannot show, what leaves the frame
};

struct Chart {
  std::string title;
  std::vector<ChartView> views;    ///< as many as the figure has names for; empty: nothing to draw, only notes
  std::vector<std::string> notes;  ///< said below whatever the view: refused, diverged and failed cases
  int height = 0;                  ///< pixels; 0: as the page's style says
  int only_view = -1;              ///< the one view of the figure that shows this chart, which then has one view itself
};

/// An entry of a figure's legend; `dash` in the SVG sense, `symbol` an ECharts symbol or "".
struct LegendEntry {
  std::string name, colour, dash, symbol;
  std::string heading = {};  ///< entries of one heading stand in one line
};

/// Small multiples that share one legend, one set of views, and (over time) one zoom.
struct Figure {
  std::string id, title, caption;
  std::vector<std::string> views;
  std::vector<Chart> charts;
  std::vector<LegendEntry> legend;
  bool over_time = false;  ///< linked zoom along x
  bool linked = false;     ///< the same where nothing is left out of the data, so that areas keep their edges
};

/// The figures of a study, by its kind; a kind without figures of its own has none.
std::vector<Figure> make_figures(const CaseView& view, CurveData& curves);

/// Columns of a curve that the figures over time show, for sizing CurveData.
size_t series_shown(const StudyResults& results);

/// The makers behind make_figures() for kind `trajectory`; each figure in its own file or function.
std::vector<Figure> time_figures(const CaseView& view, CurveData& curves);
std::vector<Figure> axis_figures(const CaseView& view);

}  // namespace ricochet::report
