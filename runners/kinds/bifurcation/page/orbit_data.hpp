#pragma once
#include <string>

#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"

namespace ricochet::report {

/// How many numbers of sections and portraits a page may carry.
struct PageBudget {
  size_t points = 400'000;     ///< of all sections together, shared evenly by the cases that need it
  size_t portraits = 600'000;  ///< samples of all portraits together
};

/// Writes the section points of all cases into the page, as blocks ID/points/orbit, …/u and …/v of equal length: the
/// row in the case's `values`, tip displacement (m) and tip velocity (m/s). Of orbits that repeat (periodic, no
/// contact), points that coincide to 1/4000 of the case's extent in both are written once; where the budget does not
/// hold the rest, each of the other orbits keeps an even choice. Returns a sentence on what was left out, "" when
/// nothing was.
std::string put_points(const CaseView& view, CurveData& curves, const PageBudget& budget = {});

/// The same for stored portraits: ID/portrait/orbit, …/t (s), …/u and …/v. Where the budget does not hold them all,
/// every k-th orbit that has one keeps its own whole.
std::string put_portraits(const CaseView& view, CurveData& curves, const PageBudget& budget = {});

/// What the page's script knows of the orbits of each case: every column of `values`, the group that colours it, and
/// the kind of its start. Then the interval of the parameter that it stands for, half-way to its neighbours of the same
/// start, and the range of the section's displacements. Writes the points and portraits as well; `said` tells what was
/// left out.
nlohmann::ordered_json orbit_data(const CaseView& view, CurveData& curves);

}  // namespace ricochet::report
