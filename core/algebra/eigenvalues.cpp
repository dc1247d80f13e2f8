#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
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

}  // namespace ricochet
