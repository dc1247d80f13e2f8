#include <cmath>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>

namespace ricochet {
namespace {

SparseMatrix diagonal(const Eigen::VectorXd& entries) {
  SparseMatrix matrix(entries.size(), entries.size());
  for (int i = 0; i < entries.size(); ++i) matrix.insert(i, i) = entries[i];
  return matrix;
}

RowMatrix dense_rows(const Eigen::MatrixXd& matrix) {
  RowMatrix rows;
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.cols(); ++j) {
      rows.index.push_back(j);
      rows.value.push_back(matrix(i, j));
    }
    rows.start.push_back(static_cast<int>(rows.index.size()));
  }
  return rows;
}

// 2 ζ_k √(μ_k κ_k) of elastic modes in the order of their frequencies; μ ascends, so that they stand last first.
Eigen::VectorXd damping_of_modes(const Damping& damping, const Eigen::VectorXd& mu, const Eigen::VectorXd& stiff) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(mu.size());
  std::size_t number = 0;
  for (Eigen::Index i = mu.size(); i-- > 0;)
    if (mu[i] > 0 && stiff[i] > 0) out[i] = 2 * damping.ratio(number++) * std::sqrt(mu[i] * stiff[i]);
  return out;
}

}  // namespace

Eigen::MatrixXd RowMatrix::dense(int columns) const {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows(), columns);
  for (int i = 0; i < rows(); ++i)
    for (int k = start[static_cast<std::size_t>(i)]; k < start[static_cast<std::size_t>(i) + 1]; ++k)
      matrix(i, index[static_cast<std::size_t>(k)]) += value[static_cast<std::size_t>(k)];
  return matrix;
}

RowMatrix RowMatrix::behind(const RowMatrix& other) const {
  RowMatrix all = other;
  for (std::size_t i = 1; i < start.size(); ++i) all.start.push_back(other.start.back() + start[i]);
  all.index.insert(all.index.end(), index.begin(), index.end());
  all.value.insert(all.value.end(), value.begin(), value.end());
  return all;
}

RowMatrix RowMatrix::from(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix) {
  RowMatrix rows;
  for (int i = 0; i < matrix.rows(); ++i) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(matrix, i); it; ++it) {
      rows.index.push_back(static_cast<int>(it.col()));
      rows.value.push_back(it.value());
    }
    rows.start.push_back(static_cast<int>(rows.index.size()));
  }
  return rows;
}

MarchModel::MarchModel(std::shared_ptr<const SemiDiscrete> problem, bool modal)
    : problem_(std::move(problem)), rows_(problem_->dofs()) {
  const SemiDiscrete& p = *problem_;
  if (modal)
    find_modes();
  else
    shape_ = p.support_shape;
  contact_ = in_model(p.contact);
  if (p.changed_by_law()) measured_ = in_model(p.law_rows);
  tip_ = in_model(p.tip);
  if (p.rubbing.empty()) return;
  rubbed_ = in_model(p.rubbed.rows);
  pushed_ = rubbed_.behind(measured());
}

void MarchModel::find_modes() {
  const SemiDiscrete& p = *problem_;
  const Eigen::MatrixXd K(p.stiffness), M = dense_mass(p.inertia);
  if (!p.held && p.asks_for_modes()) shift_ = elastic_shift(p.stiffness, M.sparseView(), p.inertia.kernel_dimension);
  const SymmetricModes modes = symmetric_modes(M, shift_ == 0 ? K : K + shift_ * M);
  modes_ = modes.vectors;
  Eigen::VectorXd mu = modes.values;
  for (int i = 0; i < p.inertia.kernel_dimension; ++i) mu[i] = 0;
  Eigen::VectorXd stiff = Eigen::VectorXd::Ones(rows_);
  if (shift_ != 0)
    for (int i = 0; i < rows_; ++i) stiff[i] = std::abs(1 - shift_ * mu[i]) < rigid_mode ? 0 : 1 - shift_ * mu[i];
  stiffness_ = diagonal(stiff);
  if (p.damping.by_modes()) damping_ = damping_of_modes(p.damping, mu, stiff);
  inertia_.mass = diagonal(mu);
  inertia_.kernel_dimension = p.inertia.kernel_dimension;
  shape_ = modes_.transpose() * p.support_shape;
}

RowMatrix MarchModel::in_model(const SparseRows& rows) const {
  return modal() ? dense_rows(rows * modes_) : RowMatrix::from(rows);
}

// Modal rows have no zeros.
double MarchModel::times_full(const RowMatrix& rows, int row, const double* x) const {
  return flight_kernels().dot(rows_, rows.value.data() + static_cast<std::ptrdiff_t>(row) * rows_, x);
}

Eigen::VectorXd MarchModel::to_model(const Eigen::VectorXd& nodal) const {
  if (!modal()) return nodal;
  // φᵀ(K + σM)φ = 1, hence Φ⁻¹ = Φᵀ(K + σM).
  const auto in_modes = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd push = problem_->stiffness * x;
    if (shift_ != 0) push += shift_ * apply_mass(problem_->inertia, x);
    return Eigen::VectorXd(modes_.transpose() * push);
  };
  // K x is rounded to its largest terms: the second turn gives back what that leaves of x.
  Eigen::VectorXd model = in_modes(nodal);
  model += in_modes(nodal - modes_ * model);
  return model;
}

Eigen::VectorXd MarchModel::to_nodal(const Eigen::VectorXd& model) const {
  return modal() ? Eigen::VectorXd(modes_ * model) : model;
}

void MarchModel::load_to_model(const double* in, double* out) const {
  const Eigen::Map<const Eigen::VectorXd> load(in, rows_);
  Eigen::Map<Eigen::VectorXd> result(out, rows_);
  if (modal())
    result.noalias() = modes_.transpose() * load;
  else
    result = load;
}

}  // namespace ricochet
