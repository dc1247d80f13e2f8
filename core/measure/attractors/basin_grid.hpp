#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <vector>

/// \file
/// Basins of several cases on one grid: which cells of a case end alike, and which ends of different cases are one
/// attractor.
///
/// On a grid of initial states the attractors are the same in every cell. Cells that have one end (attractors.hpp)
/// belong together wherever they lie. On a grid of parameters attractors move from cell to cell. Neighbours belong
/// together where the section of one continues that of the other (kAlongParameter). A region is what such neighbours
/// join.
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
/// s = 1: a smooth boundary; s < 1: a fractal one; s = 0: no accuracy helps. `labels` is row after row
/// (rows × columns), one label per cell, < 0 where the end is not known. One row is a line, d = 1. A known cell is
/// uncertain at ε where a cell ε further along an axis (up to 2d of them) is known and ends differently. Then f(ε) is
/// the share of the known cells that are uncertain. The sizes are ε = 1, 2, 4, … cells, up to a quarter of the shorter
/// side. Usable sizes have 0 < f ≤ 0.8: beyond, ε is too large for this boundary. The exponent s is the least-squares
/// slope of ln f over ln ε. Its 95 % interval joins the scatter (Student) and the counts, 1/√n with n uncertain cells
/// that lie 2ε apart. Nothing with fewer than 3 usable sizes. Throws std::invalid_argument when the labels do not fill
/// the grid. Source: Grebogi, McDonald, Ott and Yorke (1983), Phys. Lett. A 99, 415–418.
std::optional<Interval> uncertainty_exponent(const std::vector<int>& labels, int columns, int rows);

/// Which cells of a grid need to be marched, so that only boundaries between unlike cells are known at full resolution.
///
/// Marched first are a coarse grid (every fourth column and row, and the last ones) and the whole frame of the grid.
/// The coarse grid cuts it into blocks that share their edges. A block in which any two known cells are unlike is cut
/// in four, or in two where it is one cell wide. The corners of the parts are marched, until blocks are alike or one
/// cell wide both ways. What a neighbour finds on a shared edge counts. Cells of blocks that stay alike are filled from
/// their nearest corner.
///
/// A region consists of like cells joined by an edge or a corner. It is found whole where it holds a cell of the coarse
/// grid or of the frame, however thin it becomes. An island that holds neither, hence no square of 4 × 4 cells, is not
/// found: that is the price. The frame is marched because a tongue that enters from outside would else be such an
/// island.
class GridRefinement {
 public:
  /// Whether two marched cells end alike: an equivalence, or as good as one among the cells of a block.
  using Alike = std::function<bool(std::size_t cell, std::size_t other)>;

  /// Cells are numbered column + columns · row. Not `refine`: every cell is marched, at once.
  GridRefinement(std::size_t columns, std::size_t rows, bool refine, Alike alike);

  /// The cells to be marched next, ascending; none when the grid is known. Every cell of the last call must be marched
  /// by now.
  std::vector<std::size_t> next();
  void set_marched(std::size_t cell) { marched_[cell] = true; }

  bool marched(std::size_t cell) const { return marched_[cell]; }
  /// The marched cell that each cell takes its end from: itself, or the nearest corner of its block. Where nothing is
  /// known yet it is the number of cells.
  std::vector<std::size_t> sources() const;
  /// How many cells the first call of next() asks for.
  static std::size_t first_cells(std::size_t columns, std::size_t rows, bool refine);

 private:
  struct Block {
    std::size_t left, right, low, high;  // corners, inclusive
  };
  std::size_t cell(std::size_t column, std::size_t row) const { return column + columns_ * row; }
  bool alike(const Block& block) const;
  std::vector<std::size_t> begin();
  bool want_corners(const Block& block, std::vector<std::size_t>& wanted) const;

  std::size_t columns_, rows_;
  Alike alike_;
  std::vector<bool> marched_;
  std::vector<Block> blocks_;
  bool begun_ = false, refine_;
};

}  // namespace ricochet
