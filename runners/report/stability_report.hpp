#pragma once
#include <string>
#include <vector>

#include "runners/report/figures.hpp"

/// \file
/// The sections of a report of kind `stability`, from the tables that its cases carry. Empty where they carry none.
namespace ricochet::report {

/// Spectral radius and growth per step against the step, a chart for the open structure and one for closed contact, a
/// curve per method; then, for each numeric parameter with at least three values, its map over the step: cells coloured
/// by the prediction, marked by what was observed, with the predicted boundary and the observed one over them.
std::vector<Figure> stability_figures(const CaseView& view);

/// One row per method and contact state: predicted and observed step limit, how they agree, marginal roots, and what
/// grows first.
std::string stability_html(const CaseView& view);

}  // namespace ricochet::report
