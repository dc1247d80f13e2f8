#pragma once
#include <optional>
#include <ricochet/algebra/band_ldlt.hpp>

namespace ricochet {

/// The quadratic form of an inverse, factorised once.
class InverseForm {
 public:
  explicit InverseForm(const QuasiDefinite& matrix);
  /// bᵀ z with (A + Gᵀ C_v⁻¹ G) z = b: twice the energy that a load b stores in A. Nothing where the matrix has no L D
  /// Lᵀ.
  std::optional<double> operator()(const Eigen::VectorXd& b) const;

 private:
  BandLdlt ldlt_;
  bool factorised_;
};

}  // namespace ricochet
