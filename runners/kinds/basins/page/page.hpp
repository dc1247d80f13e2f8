#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

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

/// What the page's script knows of the grids of basins: axes, labels, and the cases that have one. A label is [name,
/// colour, whether it is an attractor, whether a motion begins there]. Cells go into blocks ID/cells (indices of
/// labels). Empty where no case has a grid.
nlohmann::ordered_json basin_data(const CaseView& view, CurveData& blocks);

/// What a cell of a grid of basins may end in: an attractor, or a word for what is none.
struct BasinLabel {
  std::string name, colour;
  bool decided = true;  ///< an attractor; else undecided, failed, no start …
  bool start = true;    ///< whether a motion begins there
};

/// The cells of one case: columns × rows, row after row from the lowest y; `absent` where nothing is known yet.
struct BasinGrid {
  static constexpr std::uint8_t absent = 255;
  const CaseRecord* record = nullptr;
  std::vector<std::uint8_t> cells;
  size_t filled = 0;                      ///< cells that take the end of a marched one of their basin
  size_t no_starts = 0;                   ///< cells that begin beyond a stop
  std::map<std::string, size_t> reasons;  ///< of cells that failed: how many
};

/// The grids of a study of kind `basins`, with labels and axes that all cases share. A label has its colour whatever
/// the order of the cases.
struct Basins {
  Quantity x, y;
  std::vector<double> xs, ys;      ///< ascending
  std::vector<BasinLabel> labels;  ///< attractors by their number, then what is none
  std::vector<BasinGrid> grids;    ///< of the cases that have one, in the study's order
};

/// Empty (no grids) for other kinds, and where no case has cells. Labels beyond 250 share the last one.
Basins basins_of(const StudyResults& results);

}  // namespace ricochet::report
