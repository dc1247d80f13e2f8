#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseQR>
#include <cmath>
#include <limits>
#include <numeric>
#include <ricochet/contact_solvers/circle_solver.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/scene/massless_part.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <stdexcept>

namespace ricochet {

namespace {

constexpr Eigen::Index most_dense = 400;

/// diag(M), or what of C_v comes first in it where M stays in factors: B is as wide as an element.
Eigen::VectorXd mass_diagonal(const Inertia& inertia) {
  if (inertia.assembled()) return inertia.mass.diagonal();
  const MassFactors factors = mass_factors(inertia);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(factors.coupling.cols());
  for (int j = 0; j < factors.coupling.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(factors.coupling, j); it; ++it)
      diagonal[j] += it.value() * it.value() / factors.velocity_mass.coeff(it.row(), it.row());
  return diagonal;
}

InverseForm shifted_stiffness(const SparseMatrix& stiffness, const Inertia& inertia) {
  const Eigen::VectorXd mass = mass_diagonal(inertia), stiff = stiffness.diagonal();
  double fastest = 0;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (mass[i] > 0) fastest = std::max(fastest, stiff[i] / mass[i]);
  const double shift = 1e3 * fastest;
  QuasiDefinite matrix = weighted_system(1, stiffness, shift, inertia);
  // K alone may let the structure move freely.
  matrix.border_first = true;
  return InverseForm(matrix);
}

}  // namespace

MasslessPart::MasslessPart(const SparseMatrix& stiffness, const Inertia& inertia) : stiffness_(stiffness) {
  if (stiffness.rows() <= most_dense) {
    basis_ = mass_kernel(inertia);
    reduced_.emplace(basis_.transpose() * (stiffness * basis_));
  } else {
    shifted_.emplace(shifted_stiffness(stiffness, inertia));
  }
}

Eigen::VectorXd MasslessPart::response(const Eigen::VectorXd& load) const {
  if (reduced_) return basis_ * reduced_->solve(basis_.transpose() * load);
  std::optional<Eigen::VectorXd> response = shifted_->solve(load);
  constexpr int most = 40;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; response && k < most; ++k) {
    Eigen::VectorXd next = *shifted_->solve(stiffness_ * *response);
    // Lengths of K: rotations and displacements do not compare.
    const Eigen::VectorXd way = next - *response;
    const double change = way.dot(stiffness_ * way);
    response = std::move(next);
    if (!(change < 0.25 * before)) return *response;
    before = change;
  }
  throw std::logic_error("the massless part of the structure has no stiffness of its own");
}

double MasslessPart::energy(const Eigen::VectorXd& load) const {
  if (!reduced_) return 0.5 * load.dot(response(load));
  const Eigen::VectorXd residual = basis_.transpose() * load;
  return 0.5 * residual.dot(reduced_->solve(residual));
}

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

namespace {

// Nothing that an effort moves.
class NoColumns final : public DelassusColumns {
 public:
  explicit NoColumns(int points) : column_(static_cast<std::size_t>(points), 0.0) {}
  const double* column(int) override { return column_.data(); }

 private:
  std::vector<double> column_;
};

}  // namespace

std::vector<double> standing_force(ContactLaw& law, const StandingPoints& at) {
  const auto lanes = static_cast<std::size_t>(at.lanes), size = static_cast<std::size_t>(at.points) * lanes;
  std::vector<double> force(size, 0.0), memory(size * static_cast<std::size_t>(law.memory_per_point()), 0.0);
  const std::vector<double> still(size, 0.0);
  std::vector<int> touched(lanes);
  std::iota(touched.begin(), touched.end(), 0);
  std::vector<LaneOutcome> outcome(lanes);
  NoColumns columns(at.points);
  ReducedProblem problem;
  problem.points = at.points;
  problem.lanes = at.lanes;
  problem.delassus = &columns;
  problem.free = problem.before = at.place;
  problem.lower = at.lower;
  problem.upper = at.upper;
  problem.rate_free = at.rate ? at.rate : still.data();
  problem.memory = at.memory ? at.memory : memory.empty() ? nullptr : memory.data();
  problem.effort = force.data();
  problem.touched = touched;
  problem.outcome = outcome.data();
  CircleSolver circles;
  circles.prepare(at.points, at.lanes, at.circles, law.memory_per_point());
  circles.solve(law, problem);
  for (std::size_t lane = 0; lane < lanes; ++lane)
    if (!outcome[lane].converged)
      for (std::size_t i = lane; i < size; i += lanes) force[i] = 0;
  return force;
}

}  // namespace ricochet
