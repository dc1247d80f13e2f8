#include <cmath>
#include <ricochet/algebra/eigenvalues.hpp>
#include <ricochet/measure/stability/contact_spring.hpp>

namespace ricochet {

std::optional<ContactSpring> contact_spring(const SemiDiscrete& problem, double stiffness) {
  if (problem.points() == 0) return std::nullopt;
  const Eigen::VectorXd h = Eigen::MatrixXd(problem.contact).row(problem.points() - 1).transpose();
  const Eigen::MatrixXd held = Eigen::MatrixXd(problem.stiffness) + stiffness * h * h.transpose();
  const SymmetricModes modes = symmetric_modes(dense_mass(problem.inertia), held);
  if (!modes.found) return std::nullopt;
  const Eigen::VectorXd shares = stiffness * (modes.vectors.transpose() * h).array().square();
  Eigen::Index most = 0;
  shares.maxCoeff(&most);
  const double mu = modes.values[most];
  constexpr double massless = 1e-12;  // of the largest
  if (!(mu > massless * modes.values.maxCoeff())) return std::nullopt;
  return ContactSpring{stiffness, stiffness * mu, 1 / std::sqrt(mu)};
}

}  // namespace ricochet
