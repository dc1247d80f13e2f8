#pragma once
#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"

namespace ricochet::report {

/// What the page's script knows of the grids of basins: axes, labels [name, colour, whether it is an attractor,
/// whether a motion begins there], and
/// the cases that have one, whose cells go into blocks ID/cells (indices of labels). Empty where no case has a grid.
nlohmann::ordered_json basin_data(const CaseView& view, CurveData& blocks);

}  // namespace ricochet::report
