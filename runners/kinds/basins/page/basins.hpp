#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

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

/// The grids of a study of kind `basins`, with labels and axes that all cases share: a label has its colour whatever
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
