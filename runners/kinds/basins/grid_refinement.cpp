#include "runners/kinds/basins/grid_refinement.hpp"

#include <algorithm>

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

}  // namespace

GridRefinement::GridRefinement(std::size_t columns, std::size_t rows, bool refine)
    : columns_(columns), rows_(rows), labels_(columns * rows, -1), refine_(refine) {}

std::size_t GridRefinement::coarse_cells(std::size_t columns, std::size_t rows, bool refine) {
  return refine ? coarse(columns).size() * coarse(rows).size() : columns * rows;
}

bool GridRefinement::alike(const Block& block) const {
  int first = -1;
  for (std::size_t row = block.low; row <= block.high; ++row)
    for (std::size_t column = block.left; column <= block.right; ++column) {
      const int label = labels_[cell(column, row)];
      if (label < 0) continue;
      if (first >= 0 && label != first) return false;
      first = label;
    }
  return true;
}

std::vector<std::size_t> GridRefinement::next() {
  std::vector<std::size_t> wanted;
  if (!refine_) {
    for (std::size_t i = 0; !begun_ && i < labels_.size(); ++i) wanted.push_back(i);
    begun_ = true;
    return wanted;
  }
  const auto want_corners = [&](const Block& block) {
    bool known = true;
    for (const std::size_t column : {block.left, block.right})
      for (const std::size_t row : {block.low, block.high}) {
        if (marched(cell(column, row))) continue;
        wanted.push_back(cell(column, row));
        known = false;
      }
    return known;
  };
  std::vector<Block> open, left;
  if (!begun_) {
    begun_ = true;
    const std::vector<std::size_t> across = coarse(columns_), up = coarse(rows_);
    for (std::size_t j = 0; j + 1 < std::max<std::size_t>(2, up.size()); ++j)
      for (std::size_t i = 0; i + 1 < std::max<std::size_t>(2, across.size()); ++i)
        open.push_back(
            {across[i], across[std::min(i + 1, across.size() - 1)], up[j], up[std::min(j + 1, up.size() - 1)]});
  } else {
    open.swap(blocks_);
  }
  while (!open.empty()) {
    const Block block = open.back();
    open.pop_back();
    const bool smallest = block.right - block.left < 2 && block.high - block.low < 2;
    if (!want_corners(block) || smallest || alike(block)) {
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
  std::vector<std::size_t> sources(labels_.size(), labels_.size());
  for (std::size_t i = 0; i < labels_.size(); ++i)
    if (marched(i)) sources[i] = i;
  for (const Block& block : blocks_) {
    const auto corner = [&](std::size_t at, std::size_t low, std::size_t high) {
      return 2 * at <= low + high ? low : high;
    };
    if (!alike(block)) continue;
    for (std::size_t row = block.low; row <= block.high; ++row)
      for (std::size_t column = block.left; column <= block.right; ++column) {
        const std::size_t here = cell(column, row);
        const std::size_t nearest = cell(corner(column, block.left, block.right), corner(row, block.low, block.high));
        if (sources[here] == labels_.size() && marched(nearest)) sources[here] = nearest;
      }
  }
  return sources;
}

}  // namespace ricochet
