#include <algorithm>
#include <numeric>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/scene/structure/band_order.hpp>

namespace ricochet {
namespace {

class BandOrder {
 public:
  explicit BandOrder(const SparseMatrix& pattern) : next_(static_cast<std::size_t>(pattern.rows())) {
    for (int j = 0; j < pattern.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(pattern, j); it; ++it)
        if (it.row() != it.col()) next_[static_cast<std::size_t>(j)].push_back(static_cast<int>(it.row()));
    for (auto& list : next_)
      std::sort(list.begin(), list.end(),
                [&](int a, int b) { return std::pair(degree(a), a) < std::pair(degree(b), b); });
    level_.assign(next_.size(), -1);
  }

  std::vector<int> find() {
    std::vector<int> order;
    std::vector<bool> done(next_.size(), false);
    for (std::size_t i = 0; i < next_.size(); ++i) {
      if (done[i]) continue;
      const std::vector<int> component = walk(end_of(static_cast<int>(i)));
      for (const int row : component) done[static_cast<std::size_t>(row)] = true;
      order.insert(order.end(), component.begin(), component.end());
    }
    std::reverse(order.begin(), order.end());
    return order;
  }

 private:
  std::size_t degree(int row) const { return next_[static_cast<std::size_t>(row)].size(); }

  /// Breadth first, neighbours of few neighbours first; levels as they are met.
  std::vector<int> walk(int from) {
    std::fill(level_.begin(), level_.end(), -1);
    std::vector<int> met = {from};
    level_[static_cast<std::size_t>(from)] = 0;
    for (std::size_t k = 0; k < met.size(); ++k)
      for (const int other : next_[static_cast<std::size_t>(met[k])])
        if (level_[static_cast<std::size_t>(other)] < 0) {
          level_[static_cast<std::size_t>(other)] = level_[static_cast<std::size_t>(met[k])] + 1;
          met.push_back(other);
        }
    return met;
  }

  /// A node from which the levels are as many as can be found by going to the far end again and again.
  int end_of(int from) {
    int depth = -1;
    while (true) {
      const std::vector<int> met = walk(from);
      const int deepest = level_[static_cast<std::size_t>(met.back())];
      if (deepest <= depth) return from;
      depth = deepest;
      int best = met.back();
      for (const int row : met)
        if (level_[static_cast<std::size_t>(row)] == deepest && degree(row) < degree(best)) best = row;
      from = best;
    }
  }

  std::vector<std::vector<int>> next_;
  std::vector<int> level_;
};

int width_of(const SparseMatrix& pattern, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  int width = 0;
  for (int j = 0; j < pattern.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(pattern, j); it; ++it)
      width = std::max(width, std::abs(place[static_cast<std::size_t>(it.row())] - place[static_cast<std::size_t>(j)]));
  return width;
}

}  // namespace

std::vector<int> narrow_order(const SparseMatrix& pattern) {
  std::vector<int> given(static_cast<std::size_t>(pattern.rows()));
  std::iota(given.begin(), given.end(), 0);
  std::vector<int> found = BandOrder(pattern).find();
  return width_of(pattern, found) < width_of(pattern, given) ? found : given;
}

}  // namespace ricochet
