#pragma once
#include <cstddef>
#include <vector>

namespace ricochet {

/// A small symmetric system over the active points of one lane, A = reach·W + compliance·I, factorised by L D Lᵀ.
/// Allocates in reserve() only.
struct ActiveSystem {
  std::vector<int> points;
  std::vector<double> matrix, right, slopes;
  std::size_t capacity = 0;

  void reserve(int most);
  double& at(std::size_t i, std::size_t j) { return matrix[i * capacity + j]; }
  /// L below the diagonal, D on it; zero for a point that depends on those before it.
  void factorise();
  /// Solves for `right` in place; a point that depends on the others carries nothing.
  void solve();
};

}  // namespace ricochet
