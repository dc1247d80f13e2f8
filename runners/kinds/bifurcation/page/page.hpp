#pragma once
#include <string>

#include "runners/report/choices.hpp"
#include "runners/report/curve_data.hpp"
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `bifurcation` shows: the diagram with its orbits, and distances between methods.
namespace ricochet::report {

KindPage bifurcation_page();

/// Distances to the reference over values and starts: median, what the middle 80 % reach, how many are exactly zero.
/// The row without a case is the null level.
Table distance_spreads(const Choices& choices);
/// The median over the starts at each value of the parameter; rows without a case are the null level.
Table distance_medians(const Choices& choices);
/// How often each method gave an exponent, and at how many values and starts one of a marginal root is set apart.
Table exponent_methods(const Choices& choices);

/// What the study answers: verdicts, how often each regime occurs by method beside its numerical viscosity, where
/// regimes change. Empty where no case left orbits.
std::string dynamics_answer_html(const Choices& choices);

/// Attractors, shifts of located changes, agreement of regimes between methods as a heat map, all located changes.
std::string dynamics_tables_html(const Choices& choices);

/// How many numbers of sections and portraits a page may carry.
struct PageBudget {
  size_t points = 400'000;     ///< of all sections together, shared evenly by the cases that need it
  size_t portraits = 600'000;  ///< samples of all portraits together
};

/// Writes the section points of all cases into the page, as blocks ID/points/orbit, …/u and …/v of equal length. They
/// are the row in the case's `values`, tip displacement (m) and tip velocity (m/s). Of orbits that repeat (periodic, no
/// contact), points that coincide to 1/4000 of the case's extent in both are written once. Where the budget does not
/// hold the rest, each of the other orbits keeps an even choice. Returns a sentence on what was left out, "" when
/// nothing was.
std::string put_points(const Choices& choices, CurveData& curves, const PageBudget& budget = {});

/// The same for stored portraits: ID/portrait/orbit, …/t (s), …/u and …/v. Where the budget does not hold them all,
/// every k-th orbit that has one keeps its own whole.
std::string put_portraits(const Choices& choices, CurveData& curves, const PageBudget& budget = {});

/// What the page's script knows of the orbits of each case: every column of `values`, the group that colours it, the
/// kind of its start. Then the interval of the parameter that it stands for, half-way to its neighbours of the same
/// start, and the range of the section's displacements. Writes the points and portraits as well; `said` tells what was
/// left out.
nlohmann::ordered_json orbit_data(const Choices& choices, CurveData& curves);

}  // namespace ricochet::report
