#pragma once
#include <string>

#include "runners/report/case_view.hpp"

/// \file
/// The sections of a report of kinds `bifurcation` and `basins`, from what their cases leave and from what is derived
/// of all of them. Each is empty where the results have nothing of the kind.
namespace ricochet::report {

/// Kind `basins`: what the cells end in by case, how fractal the boundary is, how many cells depend on the method.
std::string basins_html(const CaseView& view);

/// What the study answers: verdicts, how often each regime occurs by method beside its numerical viscosity, where
/// regimes change.
std::string dynamics_answer_html(const CaseView& view);

/// Attractors, shifts of located changes, agreement of regimes between methods as a heat map, all located changes.
std::string dynamics_tables_html(const CaseView& view);

}  // namespace ricochet::report
