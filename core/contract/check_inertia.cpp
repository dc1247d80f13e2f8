#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <ricochet/contract/check_inertia.hpp>
#include <ricochet/contract/fingerprint.hpp>
#include <ricochet/contract/mass_strategy.hpp>

namespace ricochet {
namespace {

using Wrong = std::optional<std::string>;

template <class Use>
void each_entry(const SparseMatrix& matrix, Use use) {
  for (Eigen::Index j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) use(it.row(), it.col(), it.value());
}

Wrong check_finite(const SparseMatrix& matrix, const char* name) {
  Wrong wrong;
  each_entry(matrix, [&](Eigen::Index i, Eigen::Index j, double value) {
    if (!std::isfinite(value) && !wrong) wrong = fmt::format("{} holds {} at ({}, {})", name, value, i, j);
  });
  return wrong;
}

Wrong check_diagonal(const SparseMatrix& matrix, const char* name) {
  for (Eigen::Index i = 0; i < matrix.cols(); ++i)
    if (matrix.coeff(i, i) < 0) return fmt::format("{} has {:g} on its diagonal, at {}", name, matrix.coeff(i, i), i);
  return std::nullopt;
}

// D M D with D = diag(M)^{-1/2}; where the diagonal vanishes, the largest stands for it.
SparseMatrix scaled(const SparseMatrix& matrix) {
  Eigen::VectorXd diagonal = matrix.diagonal();
  const double largest = diagonal.size() > 0 && diagonal.maxCoeff() > 0 ? diagonal.maxCoeff() : 1;
  for (double& value : diagonal)
    if (value == 0) value = largest;
  const Eigen::VectorXd scales = diagonal.cwiseSqrt().cwiseInverse();
  return scales.asDiagonal() * matrix * scales.asDiagonal();
}

Wrong check_symmetric(const SparseMatrix& matrix, const char* name) {
  const SparseMatrix turned = matrix.transpose();
  if (same_places(matrix, turned) && (matrix.coeffs() == turned.coeffs()).all()) return std::nullopt;
  const SparseMatrix whole = scaled(matrix), transposed = whole.transpose();
  const SparseMatrix gap = whole - transposed;
  const double tolerance = 1e-12 * whole.norm();
  Wrong wrong;
  each_entry(gap, [&](Eigen::Index i, Eigen::Index j, double value) {
    if (std::abs(value) > tolerance && !wrong)
      wrong = fmt::format("{} is not symmetric: {:g} at ({}, {}), {:g} at ({}, {})", name, matrix.coeff(i, j), i, j,
                          matrix.coeff(j, i), j, i);
  });
  return wrong;
}

// Whether M + shift·I is positive definite: a Cholesky factorisation needs no pivots to tell.
bool positive(const SparseMatrix& matrix, double shift) {
  SparseMatrix identity(matrix.rows(), matrix.cols());
  identity.setIdentity();
  const SparseMatrix shifted = matrix + shift * identity;
  return Eigen::SimplicialLLT<SparseMatrix>(shifted).info() == Eigen::Success;
}

Wrong check_sizes(const Inertia& inertia, int n) {
  const SparseMatrix &M = inertia.mass, &B = inertia.coupling, &C = inertia.velocity_mass, &R = inertia.inverse;
  if ((M.rows() > 0) + inertia.factored() + inertia.inverted() > 1)
    return "gives its mass in several forms; expected one: the matrix, its factors or its inverse";
  if (inertia.inverted()) {
    if (R.rows() != n || R.cols() != n)
      return fmt::format("its inverse is {} × {}; expected {} × {}, the dofs of the space", R.rows(), R.cols(), n, n);
    return std::nullopt;
  }
  if (!inertia.factored()) {
    if (M.rows() != n || M.cols() != n)
      return fmt::format("its mass is {} × {}; expected {} × {}, the dofs of the space", M.rows(), M.cols(), n, n);
    return std::nullopt;
  }
  if (B.cols() != n)
    return fmt::format("its B is {} × {}; expected {} columns, the dofs of the space", B.rows(), B.cols(), n);
  if (C.rows() != B.rows() || C.cols() != B.rows())
    return fmt::format("its C_v is {} × {}; expected {} × {}, the rows of B", C.rows(), C.cols(), B.rows(), B.rows());
  return std::nullopt;
}

Wrong check_values(const Inertia& inertia) {
  const SparseMatrix& matrix = inertia.factored()   ? inertia.velocity_mass
                               : inertia.inverted() ? inertia.inverse
                                                    : inertia.mass;
  const char* name = inertia.factored() ? "C_v" : inertia.inverted() ? "the inverse" : "the mass";
  if (inertia.factored())
    if (auto wrong = check_finite(inertia.coupling, "B")) return wrong;
  if (auto wrong = check_finite(matrix, name)) return wrong;
  if (auto wrong = check_diagonal(matrix, name)) return wrong;
  if (auto wrong = check_symmetric(matrix, name)) return wrong;
  // One factorisation tells the rank too.
  if (inertia.assembled() && semidefinite_rank(matrix) == matrix.rows()) return std::nullopt;
  constexpr double round_off = 1e-11, regular = 1e-12;
  if (!positive(scaled(matrix), inertia.assembled() ? round_off : -regular))
    return inertia.assembled() ? std::string("the mass has a negative eigenvalue")
                               : std::string(name) + " is not positive definite";
  return std::nullopt;
}

Wrong check_kernel(const Inertia& inertia, int n) {
  if (inertia.kernel_dimension < 0 || inertia.kernel_dimension > n)
    return fmt::format("declares a kernel of dimension {}; the mass has {} dofs", inertia.kernel_dimension, n);
  if (inertia.inverted()) {
    if (inertia.kernel_dimension == 0) return std::nullopt;
    return fmt::format("declares a kernel of dimension {}, a mass that has an inverse has 0", inertia.kernel_dimension);
  }
  constexpr double regular = 1e-12;
  // A regular mass may be regular by less than a rank asks for.
  if (!inertia.factored() && inertia.kernel_dimension == 0 &&
      (semidefinite_rank(inertia.mass) == n || positive(scaled(inertia.mass), -regular)))
    return std::nullopt;
  const int kernel = n - (inertia.factored() ? row_rank(inertia.coupling) : semidefinite_rank(inertia.mass));
  if (kernel == inertia.kernel_dimension) return std::nullopt;
  return fmt::format("declares a kernel of dimension {}, its mass has {}", inertia.kernel_dimension, kernel);
}

}  // namespace

std::optional<std::string> check_inertia(const Inertia& inertia, const FiniteElementSpace& space) {
  if (auto wrong = check_sizes(inertia, space.dofs)) return wrong;
  if (auto wrong = check_values(inertia)) return wrong;
  return check_kernel(inertia, space.dofs);
}

}  // namespace ricochet
