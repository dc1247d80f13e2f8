#include <ricochet/algebra/inverse_form.hpp>

namespace ricochet {

InverseForm::InverseForm(const QuasiDefinite& matrix) : factorised_(!ldlt_.factorise(matrix)) {}

// The rows of the border are zero.
Eigen::VectorXd InverseForm::in_factor_order(const Eigen::VectorXd& b) const {
  const int rows = ldlt_.rows(), dofs = static_cast<int>(b.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows);
  for (int i = 0; i < rows; ++i)
    if (const int unknown = ldlt_.order()[static_cast<std::size_t>(i)]; unknown < dofs) right[i] = b[unknown];
  return right;
}

Block InverseForm::substitute(Eigen::VectorXd right) const {
  Block z(ldlt_.rows(), 1, ldlt_.half_width());
  BandStep step;
  ldlt_.substitute_in(step, z.data());
  step.b = right.data();
  lane_kernels(1).band_step(step);
  return z;
}

std::optional<double> InverseForm::operator()(const Eigen::VectorXd& b) const {
  if (!factorised_) return std::nullopt;
  const Eigen::VectorXd right = in_factor_order(b);
  const Block z = substitute(right);
  double form = 0;
  for (int i = 0; i < z.rows(); ++i) form += right[i] * z.data()[i];
  return form;
}

std::optional<Eigen::VectorXd> InverseForm::solve(const Eigen::VectorXd& b) const {
  if (!factorised_) return std::nullopt;
  const Block z = substitute(in_factor_order(b));
  Eigen::VectorXd solution(b.size());
  for (int i = 0; i < z.rows(); ++i)
    if (const int unknown = ldlt_.order()[static_cast<std::size_t>(i)]; unknown < b.size())
      solution[unknown] = z.data()[i];
  return solution;
}

}  // namespace ricochet
