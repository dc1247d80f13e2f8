#pragma once
#include <cstddef>
#include <functional>
#include <vector>

namespace ricochet {

/// Which cells of a grid need to be marched, so that only boundaries between unlike cells are known at full resolution.
///
/// Marched first are a coarse grid (every fourth column and row, and the last ones) and the whole frame of the grid.
/// The coarse grid cuts it into blocks that share their edges. A block in which any two known cells are unlike is cut
/// in four, whose corners are marched, until blocks are alike or one cell wide; what a neighbour finds on a shared edge
/// counts. Cells of blocks that stay alike are filled from their nearest corner.
///
/// So every region of like cells (joined by an edge or a corner) that holds a cell of the coarse grid or of the frame
/// is found whole, however thin it becomes. An island that holds neither, hence no square of 4 × 4 cells, is not found:
/// that is the price. The frame is marched because a tongue that enters from outside would else be such an island.
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
  /// The marched cell that each cell takes its end from: itself, or the nearest corner of its block; the number of
  /// cells where nothing is known yet.
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
