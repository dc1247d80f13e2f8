#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseQR>
#include <cmath>
#include <ricochet/scene/semi_discrete.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

/// 1/√Σ_i a_ij² per column: rotations and displacements then weigh the same whatever the mesh.
Eigen::VectorXd column_scales(const SparseMatrix& matrix) {
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(matrix.cols());
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const double norm = matrix.col(j).norm();
    if (norm > 0) scales[j] = 1 / norm;
  }
  return scales;
}

}  // namespace

Eigen::MatrixXd mass_kernel(const Inertia& inertia) {
  // Ker M = Ker A with A = B or M. With A D = Rᵀ Qᵀ (QR of its transpose), the last columns of Q span Ker(A D).
  const SparseMatrix& matrix = inertia.factored() ? inertia.coupling : inertia.mass;
  const Eigen::Index n = matrix.cols(), kernel = inertia.kernel_dimension;
  if (kernel == 0) return Eigen::MatrixXd(n, 0);
  const Eigen::VectorXd scales = column_scales(matrix);
  SparseMatrix transposed = (matrix * scales.asDiagonal()).transpose();
  transposed = transposed * column_scales(transposed).asDiagonal();
  transposed.makeCompressed();
  Eigen::SparseQR<SparseMatrix, Eigen::NaturalOrdering<int>> qr;
  qr.setPivotThreshold(1e-9);  // columns have length 1; the rank gap of a mesh of thousands of elements is wider
  qr.compute(transposed);
  if (qr.rank() != n - kernel)
    throw std::logic_error(
        fmt::format("a mass strategy declares a kernel of dimension {}, its matrix has {}", kernel, n - qr.rank()));
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(n, kernel);
  basis.bottomRows(kernel).setIdentity();
  basis = qr.matrixQ() * basis;
  return scales.asDiagonal() * basis;
}

Eigen::MatrixXd dense_mass(const Inertia& inertia) {
  if (inertia.assembled()) return Eigen::MatrixXd(inertia.mass);
  const MassFactors factors = mass_factors(inertia);
  const Eigen::MatrixXd B(factors.coupling), Cv(factors.velocity_mass);
  return B.transpose() * Cv.ldlt().solve(B);
}

Eigen::VectorXd apply_mass(const Inertia& inertia, const Eigen::VectorXd& x) {
  if (inertia.assembled()) return inertia.mass * x;
  const MassFactors factors = mass_factors(inertia);
  const Eigen::SimplicialLLT<SparseMatrix> velocity_mass(factors.velocity_mass);
  return factors.coupling.transpose() * velocity_mass.solve(factors.coupling * x);
}

}  // namespace ricochet
