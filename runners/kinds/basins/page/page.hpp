#pragma once
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `basins` shows: images of the cells, and where they differ.
namespace ricochet::report {

KindPage basins_page();

/// Cells of each grid of basins: how many, filled in, and how many differ from the first case's.
Table basin_counts(const CaseView& view);
/// Why cells failed, and how many.
Table basin_failures(const CaseView& view);

/// How many attractors the cells end in, how many of them depend on the method, whose boundary is fractal: a sentence
/// each. Empty where no case has cells.
std::vector<std::string> basins_said(const CaseView& view);

/// What the cells end in by case, how fractal the boundary is, how many cells depend on the method. Empty where no case
/// has cells.
std::string basins_html(const CaseView& view);

}  // namespace ricochet::report
