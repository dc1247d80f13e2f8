#pragma once
#include <memory>
#include <string>

#include "runners/kinds/basins/basin_analysis.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/curve_data.hpp"
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `basins` shows: images of the cells, and where they differ.
namespace ricochet::report {

KindPage basins_page(std::shared_ptr<const BasinAnalysis> basins);

/// Cells of each grid of basins: how many, filled in, and how many differ from the first case's.
Table basin_counts(const BasinAnalysis& basins);
/// Why cells failed, and how many.
Table basin_failures(const BasinAnalysis& basins);

/// What the cells end in by case, how fractal the boundary is, how many cells depend on the method. Empty where no case
/// has cells.
std::string basins_html(const Choices& choices, const BasinAnalysis& basins);

/// What the page's script knows of the grids of basins: axes, labels, and the cases that have one. A label is [name,
/// colour, whether it is an attractor, whether a motion begins there]. Cells go into blocks ID/cells (indices of
/// labels).
nlohmann::ordered_json basin_data(const Choices& choices, const BasinAnalysis& basins, CurveData& blocks);

}  // namespace ricochet::report
