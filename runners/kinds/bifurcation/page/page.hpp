#pragma once
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `bifurcation` shows: the diagram with its orbits, and distances between methods.
namespace ricochet::report {

KindPage bifurcation_page();

/// Distances to the reference over values and starts: median, what the middle 80 % reach, how many are exactly zero.
/// The row without a case is the null level.
Table distance_spreads(const CaseView& view);
/// The median over the starts at each value of the parameter; rows without a case are the null level.
Table distance_medians(const CaseView& view);
/// How often each method gave an exponent, and at how many values and starts one of a marginal root is set apart.
Table exponent_methods(const CaseView& view);

/// What the study answers: verdicts, how often each regime occurs by method beside its numerical viscosity, where
/// regimes change. Empty where no case left orbits.
std::string dynamics_answer_html(const CaseView& view);

/// Attractors, shifts of located changes, agreement of regimes between methods as a heat map, all located changes.
std::string dynamics_tables_html(const CaseView& view);

}  // namespace ricochet::report
