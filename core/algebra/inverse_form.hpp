#pragma once
#include <optional>
#include <ricochet/algebra/band_ldlt.hpp>

namespace ricochet {

/// bᵀ z with (A + Gᵀ C_v⁻¹ G) z = b: twice the energy that a load b stores in A. Nothing where the matrix has no L D
/// Lᵀ.
std::optional<double> inverse_form(const QuasiDefinite& matrix, const Eigen::VectorXd& b);

}  // namespace ricochet
