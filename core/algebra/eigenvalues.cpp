#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <ricochet/algebra/eigenvalues.hpp>

namespace ricochet {
namespace {

constexpr int options(EigenVectors vectors) {
  return vectors == EigenVectors::wanted ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly;
}

template <class Solver>
SymmetricModes modes_of(const Solver& solver, EigenVectors vectors) {
  SymmetricModes modes;
  modes.values = solver.eigenvalues();
  modes.found = solver.info() == Eigen::Success;
  if (vectors == EigenVectors::wanted) modes.vectors = solver.eigenvectors();
  return modes;
}

}  // namespace

SymmetricModes symmetric_modes(const Eigen::MatrixXd& A, EigenVectors vectors) {
  return modes_of(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, options(vectors)), vectors);
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, EigenVectors vectors) {
  return modes_of(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(A, B, options(vectors) | Eigen::Ax_lBx),
                  vectors);
}

GeneralModes general_modes(const Eigen::MatrixXd& A, EigenVectors vectors) {
  const bool wanted = vectors == EigenVectors::wanted;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, wanted);
  GeneralModes modes;
  modes.found = solver.info() == Eigen::Success;
  if (!modes.found) return modes;
  modes.values = solver.eigenvalues();
  if (wanted) modes.vectors = solver.eigenvectors();
  return modes;
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& A) {
  return A.jacobiSvd().singularValues();
}

Eigen::VectorXd singular_values(const Eigen::MatrixXcd& A) {
  // The real matrix of the same map has each of them twice.
  Eigen::MatrixXd map(2 * A.rows(), 2 * A.cols());
  map << A.real(), -A.imag(), A.imag(), A.real();
  const Eigen::VectorXd twice = singular_values(map);
  return twice(Eigen::seqN(0, twice.size() / 2, 2));
}

Eigen::VectorXd balance(Eigen::MatrixXd& A, double negligible) {
  const Eigen::Index n = A.rows();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  for (bool moved = true; moved;) {
    moved = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double column = A.col(i).lpNorm<1>() - std::abs(A(i, i)), row = A.row(i).lpNorm<1>() - std::abs(A(i, i));
      if (std::min(column, row) <= negligible * std::max(column, row)) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (!std::isfinite(factor) || (column * factor + row / factor) >= 0.95 * (column + row)) continue;
      scale[i] *= factor;
      A.col(i) *= factor;
      A.row(i) /= factor;
      moved = true;
    }
  }
  return scale;
}

}  // namespace ricochet
