#pragma once
#include <string>
#include <vector>

#include "runners/report/figures.hpp"

/// \file
/// The sections of a report of kinds `bifurcation` and `basins`, from what their cases leave and from what is derived
/// of all of them. Each is empty where the results have nothing of the kind.
namespace ricochet::report {

/// The bifurcation diagram: tip displacement on the section against the parameter, coloured by the regime of the
/// orbit, with exponents, regimes and verdicts in panels under it that share its horizontal axis. Views: a chart per
/// case, all cases in one chart (coloured by case), a chart per case and kind of start.
std::vector<Figure> diagram_figures(const CaseView& view, CurveData& curves);

}  // namespace ricochet::report
