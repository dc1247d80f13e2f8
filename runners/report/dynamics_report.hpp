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

/// Distances of the sections to those of the reference case, as views of one figure each: along the parameter, and
/// against every numeric axis of at least three values (the median over parameter and starts, with what the middle 80 %
/// of them reach). The null level, of two halves of one run, is a band behind both.
std::vector<Figure> distance_figures(const CaseView& view);

/// Images of the basins, one per case, with the difference to the first case as their second view.
std::vector<Figure> basin_figures(const CaseView& view, CurveData& curves);

/// Kind `basins`: what the cells end in by case, how fractal the boundary is, how many cells depend on the method.
std::string basins_html(const CaseView& view);

/// What the study answers: verdicts, how often each regime occurs by method beside its numerical viscosity, where
/// regimes change.
std::string dynamics_answer_html(const CaseView& view);

/// Attractors, shifts of located changes, agreement of regimes between methods as a heat map, all located changes.
std::string dynamics_tables_html(const CaseView& view);

}  // namespace ricochet::report
