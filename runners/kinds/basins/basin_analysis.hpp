#pragma once
#include <cstdint>
#include <map>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <string>
#include <vector>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/record.hpp"

/// \file
/// The grids of a study of kind `basins` over its cases: which ends are one attractor, and what tables, answer and page
/// ask of that.
namespace ricochet {

namespace report {

/// What a cell of a grid of basins may end in: an attractor, or a word for what is none.
struct BasinLabel {
  std::string name, colour;
  bool decided = true;  ///< an attractor; else undecided, failed, no start …
  bool start = true;    ///< whether a motion begins there
};

/// The cells of one case: columns × rows, row after row from the lowest y; `absent` where nothing is known yet.
struct BasinImage {
  static constexpr std::uint8_t absent = 255;
  const CaseRecord* record = nullptr;
  std::vector<std::uint8_t> cells = {};             ///< labels
  std::size_t filled = 0;                           ///< cells that take the end of a marched one of their basin
  std::size_t no_starts = 0;                        ///< cells that begin beyond a stop
  std::map<std::string, std::size_t> reasons = {};  ///< of cells that failed: how many
};

}  // namespace report

/// What becomes of the cells of one case.
struct BasinStarts {
  std::size_t cells = 0, no_starts = 0;    ///< all; those that begin beyond a stop
  std::size_t decided = 0, undecided = 0;  ///< of those that were marched to their end
};

struct BasinAnalysis {
  std::vector<double> xs = {}, ys = {};            ///< of the grid that all cases share, ascending
  std::vector<report::BasinLabel> labels = {};     ///< attractors by their number, then what is none; 250 at most
  std::vector<report::BasinImage> images = {};     ///< of the cases that have cells, in the study's order
  std::map<std::string, BasinStarts> starts = {};  ///< by case
  std::vector<FractionRow> fractions = {};
  std::vector<BasinDifferenceRow> differences = {};
  std::vector<UncertaintyRow> uncertainty = {};
  bool of_states = true;                        ///< whether cells are starts; else they are scenes
  std::vector<const CaseRecord*> records = {};  ///< cases with a grid
  std::vector<BasinGrid> grids = {};            ///< theirs
};

/// Compares the cases, and appends the tables of kind `basins` to results.derived: cells, attractors, basin_fractions,
/// basin_differences, basin_uncertainty (see runners/kinds/sweep/sweep_tables.hpp). Which cells end alike is told by
/// one rule (core/measure/attractors/attractors.hpp), by which the cases refined their grids as well. A motion and its
/// mirror image are one attractor. Nothing where no case has cells.
BasinAnalysis analyse_basins(StudyResults& results);

}  // namespace ricochet
