#include <ricochet/algebra/block.hpp>
#include <ricochet/algebra/inverse_form.hpp>

namespace ricochet {

InverseForm::InverseForm(const QuasiDefinite& matrix) : factorised_(!ldlt_.factorise(matrix)) {}

std::optional<double> InverseForm::operator()(const Eigen::VectorXd& b) const {
  if (!factorised_) return std::nullopt;
  const int rows = ldlt_.rows(), dofs = static_cast<int>(b.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows);
  for (int i = 0; i < rows; ++i)
    if (const int unknown = ldlt_.order()[static_cast<std::size_t>(i)]; unknown < dofs) right[i] = b[unknown];
  Block z(rows, 1, ldlt_.half_width());
  BandStep step;
  step.solve_rows = rows;
  step.solve_width = ldlt_.half_width();
  step.factor = ldlt_.factor();
  step.z = z.data();
  Eigen::VectorXd copy = right;
  step.b = copy.data();
  lane_kernels(1).band_step(step);
  double form = 0;
  for (int i = 0; i < rows; ++i) form += right[i] * z.data()[i];
  return form;
}

}  // namespace ricochet
