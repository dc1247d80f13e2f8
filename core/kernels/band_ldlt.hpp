#pragma once
#include <Eigen/SparseCore>
#include <optional>
#include <ricochet/kernels/lane_kernels.hpp>
#include <string>
#include <vector>

namespace ricochet {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Half-bandwidth of a square matrix: max |i − j| over its non-zeros.
int half_bandwidth(const SparseMatrix& matrix);

/// A square band matrix as LaneKernels reads it: n × (2w+1) by rows, or by diagonals when `by_diagonals` (one lane).
std::vector<double> band_storage(const SparseMatrix& matrix, int half_width, bool by_diagonals);

/// A symmetric matrix A (n × n) and, for the quasi-definite form, its border:
///
///     [ A    G ᵀ ] [z]   [b]
///     [ G   −C_v ] [r] = [g]        so that  (A + Gᵀ C_v⁻¹ G) z = b + Gᵀ C_v⁻¹ g                                 (1)
///
/// with A SPD and C_v SPD: L D Lᵀ exists without pivoting in any symmetric ordering (Vanderbei 1995, quasi-definite
/// matrices). The r unknowns are interleaved among the z unknowns by the largest column of their row of G. Each stands
/// after that column, or before it where `border_first`. This keeps the band narrow. With G diagonal and regular,
/// border first, A need only be semidefinite: every pivot of z then holds what its own r has brought.
struct QuasiDefinite {
  SparseMatrix A, G, Cv;  ///< G and Cv may be 0 × 0
  bool border_first = false;
  /// The whole matrix of (1), permuted; order[i] is the unknown of row i: dof, or n + j for r_j.
  SparseMatrix assemble(std::vector<int>& order) const;
};

/// L D Lᵀ of a symmetric band matrix without pivoting, stored for LaneKernels::band_step.
class BandLdlt {
 public:
  /// Fails (with a sentence) when a pivot is lost in round-off, is not finite or has the wrong sign. Pivots of dofs are
  /// positive, those of the border negative.
  std::optional<std::string> factorise(const QuasiDefinite& matrix);

  int rows() const { return rows_; }
  int half_width() const { return width_; }
  const double* factor() const { return factor_.data(); }
  /// Lets a step end with the substitution through this factor; z as in BandStep.
  void substitute_in(BandStep& step, double* z) const {
    step.solve_rows = rows_;
    step.solve_width = width_;
    step.factor = factor_.data();
    step.z = z;
  }
  /// Row of (b; g) for each row of the factor.
  const std::vector<int>& order() const { return order_; }
  /// Whether order() is the identity.
  bool natural() const { return natural_; }

 private:
  int rows_ = 0, width_ = 0;
  bool natural_ = true;
  std::vector<double> factor_;
  std::vector<int> order_;
};

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
