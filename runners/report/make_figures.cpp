#include <algorithm>
#include <iterator>

#include "runners/report/dynamics_report.hpp"
#include "runners/report/evidence.hpp"
#include "runners/report/figures.hpp"
#include "runners/report/stability_report.hpp"

namespace ricochet::report {
namespace {

void append(std::vector<Figure>& all, std::vector<Figure> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::vector<Figure> trajectory_figures(const CaseView& view, CurveData& curves) {
  std::vector<Figure> out = axis_figures(view), over_time = time_figures(view, curves);
  // What the energy ends at, how it gets there, and the rest.
  const auto rest =
      std::find_if(out.begin(), out.end(), [](const Figure& f) { return !f.id.starts_with("final-energy"); });
  out.insert(rest, std::make_move_iterator(over_time.begin()), std::make_move_iterator(over_time.end()));
  return out;
}

}  // namespace

std::vector<Figure> make_figures(const CaseView& view, CurveData& curves) {
  const std::string& kind = view.results().kind;
  std::vector<Figure> out;
  if (kind == "trajectory") append(out, trajectory_figures(view, curves));
  append(out, diagram_figures(view, curves));
  append(out, distance_figures(view));
  append(out, basin_figures(view, curves));
  append(out, stability_figures(view));
  append(out, work_precision_figures(view));
  append(out, error_figures(view));
  append(out, effects_figures(view));
  return out;
}

}  // namespace ricochet::report
