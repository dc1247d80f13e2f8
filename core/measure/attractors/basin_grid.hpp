#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <vector>

/// \file
/// Basins of several cases on one grid: which cells of a case end alike, which ends of different cases are one
/// attractor, and what that says.
///
/// On a grid of initial states the attractors are the same in every cell: cells that have one end (attractors.hpp)
/// belong together wherever they lie. On a grid of parameters attractors move from cell to cell: neighbours belong
/// together where the section of one continues that of the other (kAlongParameter), and a region is what such
/// neighbours join.
namespace ricochet {

/// What a grid goes through.
enum class GridOf { initial_states, parameters };

/// One cell of a case.
struct GridCell {
  bool present = false;  ///< whether the case has it
  MotionClass motion;
  int end = -1;        ///< within the case: cells with equal ends belong together; −1: not known
  int attractor = -1;  ///< over all cases, from 0; −1: not decided
};

/// A case on the grid.
struct BasinGrid {
  std::size_t columns = 0, rows = 0;
  std::vector<GridCell> cells;       ///< columns × rows, row after row
  std::vector<SettledSection> ends;  ///< on a grid of initial states: a section of each end
  int end_count = 0;

  /// The up to four cells beside one.
  std::vector<std::size_t> neighbours(std::size_t place) const;
};

/// The section of a cell, ready to be compared; without points where it is not known. Asked once or twice per cell.
using SectionOf = std::function<SettledSection(std::size_t place)>;

/// Fills in the ends of decided cells of a grid of initial states. Ends that the cells have already (found while they
/// were marched) stay. Cells whose section is not known take the end of the nearest cells of their class.
void find_ends(BasinGrid& grid, const SectionOf& section);
/// The same for a grid of parameters: regions.
void find_regions(BasinGrid& grid, const SectionOf& section);

/// Fills in the attractor of every cell that has an end. Grids of initial states: ends of different cases are one
/// attractor by match_owners(). Grids of parameters: a region is that of an earlier case, of its class, with which it
/// shares most cells. Attractors are numbered from the largest basin on; their classes are returned.
std::vector<MotionClass> match_attractors(std::vector<BasinGrid>& cases, GridOf grid);

/// Cells of that attractor; −1: cells that are present and undecided.
std::size_t count_cells(const BasinGrid& grid, int attractor);
/// Cells that have an attractor.
std::size_t decided_cells(const BasinGrid& grid);

/// Cells decided in both, and those of them that differ.
struct GridDifference {
  int both = 0, differ = 0;
};
GridDifference compare(const BasinGrid& a, const BasinGrid& b);

/// Share of the decided cells that have a decided neighbour of another attractor; nothing without a decided cell.
std::optional<double> boundary_share(const BasinGrid& grid);
/// Attractor of each cell, −1 where there is none.
std::vector<int> attractors_of(const BasinGrid& grid);

/// How the share of initial states whose end is uncertain falls with their uncertainty ε:
///
///     f(ε) ~ ε^s,      s = d − D,     d: dimensions of the grid, D: dimension of the basins' boundary
///
/// s = 1: a smooth boundary; s < 1: a fractal one; s = 0: no accuracy helps. `labels` is row after row (rows ×
/// columns; one row is a line, d = 1), one label per cell, < 0 where the end is not known. f(ε) is the share of the
/// known cells of which one of the (up to 2d) cells ε further along an axis is known and ends differently. ε = 1, 2, 4,
/// … cells, up to a quarter of the shorter side. Usable sizes have 0 < f ≤ 0.8: beyond, ε is too large for this
/// boundary. s is the least-squares slope of ln f over ln ε; its 95 % interval joins the scatter (Student) and the
/// counts (1/√n, n uncertain cells that lie 2ε apart). Nothing with fewer than 3 usable sizes. Throws
/// std::invalid_argument when the labels do not fill the grid. Source: Grebogi, McDonald, Ott and Yorke (1983), Phys.
/// Lett. A 99, 415–418.
std::optional<Interval> uncertainty_exponent(const std::vector<int>& labels, int columns, int rows);

}  // namespace ricochet
