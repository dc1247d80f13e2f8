#pragma once
#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"

namespace ricochet::report {

/// What the page's script knows of the branches of each case: their names, periods and symmetry, and as blocks
/// ID/branch/… of equal length the number of the branch, parameter, tip displacement (m) and velocity (m/s), arc (m),
/// count of unstable multipliers, special point (0: none) and real and imaginary parts of the multipliers. Of more than
/// `rows` rows an even choice of each branch is kept, with special points and changes of stability; `said` tells so.
/// Portraits are blocks ID/orbit/…: place of the row, first sample, stops of the tip; samples u and v; runs of contact.
nlohmann::ordered_json branch_data(const CaseView& view, CurveData& curves);

}  // namespace ricochet::report
