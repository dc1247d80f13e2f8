#pragma once
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <vector>

namespace ricochet {

/// What NodeStep reads of each node, numbers in the order in which they are needed.
///
///     down:  K of the deflection's row (6: deflection and rotation of the node before, of the node, of the next
///            one) and of the rotation's row (6), their load shapes (2), then L: without border w (2), t (3); with it
///            w (3), r (4), t (5)
///     up:    1/D and the column of L below it, farthest row first: t, (r,) w
///
/// Rows of a node in the factor are w, (r,) t.
constexpr int node_down_stride(bool border) {
  return border ? 26 : 19;
}
constexpr int node_up_stride(bool border) {
  return border ? 15 : 7;
}

/// A band of Hermite elements by nodes: K and the factor of S, packed for NodeStep. Nothing is lost by it: it is made
/// where every other entry of both is zero.
class NodeBand {
 public:
  NodeBand() = default;
  /// Empty where the matrices do not come by nodes.
  NodeBand(const SparseMatrix& K, const double* shape, const BandLdlt& factor);
  bool empty() const { return nodes_ == 0; }
  bool border() const { return border_; }
  int nodes() const { return nodes_; }
  /// Whether every row of H is one entry at the deflection of a node, rows in the order of nodes; if so, they are kept.
  bool place_points(const LaneRows& H);
  /// Nodes, matrices and points of a step.
  NodeStep step() const;

 private:
  int nodes_ = 0;
  bool border_ = false;
  bool everywhere_ = false;
  std::vector<double> down_, up_, value_, diagonals_, shape_;
  std::vector<int> point_;
};

}  // namespace ricochet
