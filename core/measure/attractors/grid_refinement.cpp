#include <algorithm>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <utility>

namespace ricochet {
namespace {

constexpr std::size_t stride = 4;

// 0, 4, 8 … and the last one.
std::vector<std::size_t> coarse(std::size_t count) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i + 1 < count; i += stride) places.push_back(i);
  places.push_back(count - 1);
  return places;
}

// The two halves of [low, high] where there is a place between, else the whole.
std::vector<std::pair<std::size_t, std::size_t>> halves(std::size_t low, std::size_t high) {
  if (high - low < 2) return {{low, high}};
  const std::size_t middle = low + (high - low) / 2;
  return {{low, middle}, {middle, high}};
}

// The coarse grid and the frame.
std::vector<std::size_t> first_places(std::size_t columns, std::size_t rows) {
  std::vector<bool> wanted(columns * rows, false);
  for (const std::size_t row : coarse(rows))
    for (const std::size_t column : coarse(columns)) wanted[column + columns * row] = true;
  for (std::size_t column = 0; column < columns; ++column)
    wanted[column] = wanted[column + columns * (rows - 1)] = true;
  for (std::size_t row = 0; row < rows; ++row) wanted[columns * row] = wanted[columns * row + columns - 1] = true;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) places.push_back(i);
  return places;
}

}  // namespace

GridRefinement::GridRefinement(std::size_t columns, std::size_t rows, bool refine, Alike alike)
    : columns_(columns), rows_(rows), alike_(std::move(alike)), marched_(columns * rows, false), refine_(refine) {}

std::size_t GridRefinement::first_cells(std::size_t columns, std::size_t rows, bool refine) {
  return refine ? first_places(columns, rows).size() : columns * rows;
}

bool GridRefinement::alike(const Block& block) const {
  const std::size_t none = marched_.size();
  std::size_t first = none;
  for (std::size_t row = block.low; row <= block.high; ++row)
    for (std::size_t column = block.left; column <= block.right; ++column) {
      const std::size_t here = cell(column, row);
      if (!marched_[here]) continue;
      if (first == none)
        first = here;
      else if (!alike_(first, here))
        return false;
    }
  return true;
}

// Blocks of the coarse grid, and the first cells.
std::vector<std::size_t> GridRefinement::begin() {
  begun_ = true;
  if (!refine_) {
    std::vector<std::size_t> all(marched_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
  }
  const std::vector<std::size_t> across = coarse(columns_), up = coarse(rows_);
  for (std::size_t j = 0; j + 1 < std::max<std::size_t>(2, up.size()); ++j)
    for (std::size_t i = 0; i + 1 < std::max<std::size_t>(2, across.size()); ++i)
      blocks_.push_back(
          {across[i], across[std::min(i + 1, across.size() - 1)], up[j], up[std::min(j + 1, up.size() - 1)]});
  return first_places(columns_, rows_);
}

// Whether all four are known; those that are not are asked for.
bool GridRefinement::want_corners(const Block& block, std::vector<std::size_t>& wanted) const {
  bool known = true;
  for (const std::size_t column : {block.left, block.right})
    for (const std::size_t row : {block.low, block.high}) {
      if (marched_[cell(column, row)]) continue;
      wanted.push_back(cell(column, row));
      known = false;
    }
  return known;
}

std::vector<std::size_t> GridRefinement::next() {
  if (!begun_) return begin();
  std::vector<std::size_t> wanted;
  std::vector<Block> open, left;
  open.swap(blocks_);
  while (!open.empty()) {
    const Block block = open.back();
    open.pop_back();
    const bool smallest = block.right - block.left < 2 && block.high - block.low < 2;
    if (!want_corners(block, wanted) || smallest || alike(block)) {
      left.push_back(block);
      continue;
    }
    for (const auto& [low, high] : halves(block.low, block.high))
      for (const auto& [west, east] : halves(block.left, block.right)) open.push_back({west, east, low, high});
  }
  blocks_ = std::move(left);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  return wanted;
}

std::vector<std::size_t> GridRefinement::sources() const {
  std::vector<std::size_t> sources(marched_.size(), marched_.size());
  for (std::size_t i = 0; i < marched_.size(); ++i)
    if (marched_[i]) sources[i] = i;
  for (const Block& block : blocks_) {
    const auto corner = [&](std::size_t at, std::size_t low, std::size_t high) {
      return 2 * at <= low + high ? low : high;
    };
    if (!alike(block)) continue;
    for (std::size_t row = block.low; row <= block.high; ++row)
      for (std::size_t column = block.left; column <= block.right; ++column) {
        const std::size_t here = cell(column, row);
        const std::size_t nearest = cell(corner(column, block.left, block.right), corner(row, block.low, block.high));
        if (sources[here] == marched_.size() && marched_[nearest]) sources[here] = nearest;
      }
  }
  return sources;
}

}  // namespace ricochet
