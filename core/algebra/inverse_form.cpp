#include <ricochet/algebra/block.hpp>
#include <ricochet/algebra/inverse_form.hpp>

namespace ricochet {

std::optional<double> inverse_form(const QuasiDefinite& matrix, const Eigen::VectorXd& b) {
  if (b.isZero(0)) return 0;
  BandLdlt ldlt;
  if (ldlt.factorise(matrix)) return std::nullopt;
  const int rows = ldlt.rows(), dofs = static_cast<int>(b.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows);
  for (int i = 0; i < rows; ++i)
    if (const int unknown = ldlt.order()[static_cast<std::size_t>(i)]; unknown < dofs) right[i] = b[unknown];
  Block z(rows, 1, ldlt.half_width());
  BandStep step;
  step.solve_rows = rows;
  step.solve_width = ldlt.half_width();
  step.factor = ldlt.factor();
  step.z = z.data();
  Eigen::VectorXd copy = right;
  step.b = copy.data();
  lane_kernels(1).band_step(step);
  double form = 0;
  for (int i = 0; i < rows; ++i) form += right[i] * z.data()[i];
  return form;
}

}  // namespace ricochet
