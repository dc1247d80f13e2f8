#pragma once
#include <cstddef>
#include <vector>

namespace ricochet {

/// Which cells of a grid need to be marched, so that only boundaries between unlike cells are known at full resolution.
///
/// A coarse grid (every fourth column and row, and the last ones) cuts the grid into blocks that share their edges. A
/// block in which any two known cells are unlike is cut in four, whose corners are marched, until blocks are alike or
/// one cell wide; what a neighbour finds on a shared edge counts. Cells of blocks that stay alike are filled from their
/// nearest corner. A basin that no known cell falls in is not found: that is the price.
class GridRefinement {
 public:
  /// Cells are numbered column + columns · row. Not `refine`: every cell is marched, at once.
  GridRefinement(std::size_t columns, std::size_t rows, bool refine);

  /// The cells to be marched next, ascending; none when the grid is known. Every cell of the last call must have its
  /// label by now.
  std::vector<std::size_t> next();
  /// Cells with equal labels (≥ 0) are alike.
  void set_label(std::size_t cell, int label) { labels_[cell] = label; }

  bool marched(std::size_t cell) const { return labels_[cell] >= 0; }
  /// The marched cell that each cell takes its end from: itself, or the nearest corner of its block; the number of
  /// cells where nothing is known yet.
  std::vector<std::size_t> sources() const;
  /// How many cells the first call of next() asks for.
  static std::size_t coarse_cells(std::size_t columns, std::size_t rows, bool refine);

 private:
  struct Block {
    std::size_t left, right, low, high;  // corners, inclusive
  };
  std::size_t cell(std::size_t column, std::size_t row) const { return column + columns_ * row; }
  bool alike(const Block& block) const;

  std::size_t columns_, rows_;
  std::vector<int> labels_;  // −1: not known
  std::vector<Block> blocks_;
  bool begun_ = false, refine_;
};

}  // namespace ricochet
