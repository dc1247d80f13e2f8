#pragma once
#include <nlohmann/json_fwd.hpp>

#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"

namespace ricochet::report {

/// The snapshots of the cases that have some, as the player reads them: by case the places, points and stops, the units
/// of the counts and the names of its blocks. Where all of them together would make the page big, of each case every
/// second instant, every third, … is left: `stride`; forces are then the mean over the longer time.
nlohmann::ordered_json snapshot_data(const CaseView& view, CurveData& blocks);

}  // namespace ricochet::report
