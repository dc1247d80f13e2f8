#pragma once
#include <optional>
#include <ricochet/algebra/band_ldlt.hpp>
#include <ricochet/algebra/block.hpp>

namespace ricochet {

/// An inverse and its quadratic form, factorised once.
class InverseForm {
 public:
  explicit InverseForm(const QuasiDefinite& matrix);
  /// bᵀ z with (A + Gᵀ C_v⁻¹ G) z = b: twice the energy that a load b stores in A. Nothing where the matrix has no L D
  /// Lᵀ.
  std::optional<double> operator()(const Eigen::VectorXd& b) const;
  /// z itself.
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& b) const;

 private:
  Eigen::VectorXd in_factor_order(const Eigen::VectorXd& b) const;
  Block substitute(Eigen::VectorXd right) const;

  BandLdlt ldlt_;
  bool factorised_;
};

}  // namespace ricochet
