#pragma once
#include "runners/report/case_view.hpp"
#include "runners/report/curve_data.hpp"
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `basins` shows: images of the cells, and where they differ.
namespace ricochet::report {

KindPage basins_page();

/// Cells of each grid of basins: how many, filled in, and how many differ from the first case's.
Table basin_counts(const CaseView& view);
/// Why cells failed, and how many.
Table basin_failures(const CaseView& view);

/// What the cells end in by case, how fractal the boundary is, how many cells depend on the method. Empty where no case
/// has cells.
std::string basins_html(const CaseView& view);

/// What the page's script knows of the grids of basins: axes, labels [name, colour, whether it is an attractor,
/// whether a motion begins there], and
/// the cases that have one, whose cells go into blocks ID/cells (indices of labels). Empty where no case has a grid.
nlohmann::ordered_json basin_data(const CaseView& view, CurveData& blocks);

}  // namespace ricochet::report
