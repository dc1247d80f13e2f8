#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <stdexcept>
#include <vector>

namespace ricochet {

/// A row-compressed matrix that owns its storage.
struct RowMatrix {
  std::vector<int> start{0}, index;
  std::vector<double> value;
  int rows() const { return static_cast<int>(start.size()) - 1; }
  /// Σ_j a_ij x_j of one row i.
  double times(int row, const double* x) const {
    const auto i = static_cast<std::size_t>(row);
    double sum = 0;
    for (auto e = static_cast<std::size_t>(start[i]); e < static_cast<std::size_t>(start[i + 1]); ++e)
      sum += value[e] * x[index[e]];
    return sum;
  }
  LaneRows view() const { return {rows(), start.data(), index.data(), value.data()}; }
  /// The columns of a symmetric matrix that is compressed are its rows.
  static LaneRows symmetric(const SparseMatrix& matrix) {
    if (!matrix.isCompressed()) throw std::logic_error("a matrix that is not compressed has no rows to read");
    return {static_cast<int>(matrix.rows()), matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr()};
  }
  /// The rows of another, and these behind them.
  RowMatrix behind(const RowMatrix& other) const;
  /// With so many columns.
  Eigen::MatrixXd dense(int columns) const;
  static RowMatrix from(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix);
};

/// The coordinates in which a program marches: nodal (q itself), or modal (q = Φ η with ΦᵀKΦ and ΦᵀMΦ diagonal).
///
/// Modes solve M φ = μ (K + σM) φ with φᵀ(K + σM)φ = 1, so that the kernel of a singular mass is μ = 0 and slow modes
/// are accurate. σ = 0, unless a structure that is not held asks_for_modes(): then σ = elastic_shift(), and ΦᵀKΦ = 1 −
/// σμ.
class MarchModel {
 public:
  MarchModel(std::shared_ptr<const SemiDiscrete> problem, bool modal);

  const SemiDiscrete& problem() const { return *problem_; }
  bool modal() const { return modes_.size() > 0; }
  int rows() const { return rows_; }
  /// K and M in these coordinates (M empty when it stays factored), and the factors.
  const SparseMatrix& stiffness() const { return modal() ? stiffness_ : problem_->stiffness; }
  const Inertia& inertia() const { return modal() ? inertia_ : problem_->inertia; }
  /// H, where the contact points are; and what the law measures and pushes along, H too unless it changed the problem.
  const RowMatrix& contact() const { return contact_; }
  const RowMatrix& measured() const { return problem_->changed_by_law() ? measured_ : contact_; }
  /// T, along which points rub; and all rows along which efforts push, measured() first.
  const RowMatrix& rubbed() const { return rubbed_; }
  const RowMatrix& pushed() const { return rubbed_.rows() > 0 ? pushed_ : measured(); }
  const RowMatrix& tip() const { return tip_; }
  /// Rows on q as rows on these coordinates.
  RowMatrix in_model(const SparseRows& rows) const;
  /// One row of these times a contiguous vector.
  double times(const RowMatrix& rows, int row, const double* x) const {
    return modal() ? times_full(rows, row, x) : rows.times(row, x);
  }
  const Eigen::VectorXd& support_shape() const { return shape_; }
  /// Diagonal of ΦᵀCΦ where damping goes by modes; else empty.
  const Eigen::VectorXd& modal_damping() const { return damping_; }

  Eigen::VectorXd to_model(const Eigen::VectorXd& nodal) const;  ///< coordinates of a displacement
  Eigen::VectorXd to_nodal(const Eigen::VectorXd& model) const;
  /// Coordinates of a load; no allocation. `in` and `out` may not overlap.
  void load_to_model(const double* in, double* out) const;

 private:
  void find_modes();
  double times_full(const RowMatrix& rows, int row, const double* x) const;

  std::shared_ptr<const SemiDiscrete> problem_;
  Eigen::MatrixXd modes_;  // Φ
  double shift_ = 0;       // σ
  Eigen::VectorXd damping_;
  int rows_ = 0;
  SparseMatrix stiffness_;  // of modes
  Inertia inertia_;
  RowMatrix contact_, measured_, tip_, rubbed_, pushed_;
  Eigen::VectorXd shape_;
};

}  // namespace ricochet
