#pragma once
#include <nlohmann/json_fwd.hpp>

#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"

namespace ricochet::report {

/// What the panel of a case shows that no figure of the page has, bounded so that the page stays small:
///
///     ledger     columns, and their numbers by case, in six digits
///     impacts    columns, and by case the first rows; the number of all of them is a measure of the case
///     portraits  by case the names of blocks with tip displacement and velocity, a few hundred points of the curve
///
/// Of a study of many cases only the ledger.
nlohmann::ordered_json panel_data(const CaseView& view, CurveData& blocks);

/// The snapshots of the cases that have some, as the player reads them: by case the places, points and stops, the units
/// of the counts and the names of its blocks. Where all of them together would make the page big, of each case every
/// second instant, every third, … is left: `stride`; forces are then the mean over the longer time.
nlohmann::ordered_json snapshot_data(const CaseView& view, CurveData& blocks);

}  // namespace ricochet::report
