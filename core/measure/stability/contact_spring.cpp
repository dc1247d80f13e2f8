#include <algorithm>
#include <cmath>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/measure/stability/contact_spring.hpp>

namespace ricochet {

std::optional<ContactSpring> contact_spring(const SemiDiscrete& problem, double stiffness, int point) {
  if (problem.points() == 0) return std::nullopt;
  if (point < 0) point = problem.points() - 1;
  const Eigen::VectorXd h = Eigen::MatrixXd(problem.contact).row(point).transpose();
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

std::optional<double> contact_compliance(ContactLaw& law, const Parameters& parameters, double depth) {
  if (law.absent() || !law.reads()) return 0;
  law.prepare(1, std::span<const Parameters>(&parameters, 1));
  if (const auto stiffness = constant_stiffness(law)) return 1 / *stiffness;
  const double secant = 0.5 * depth * depth / law.potential(depth, 0);
  return secant > 0 && std::isfinite(secant) ? std::optional(secant) : std::nullopt;
}

namespace {

constexpr std::size_t samples = 16;  // from one to the next over the values
constexpr int most_halvings = 60;
constexpr double resolution = 1e-12;  // relative

}  // namespace

std::vector<Grazing> find_grazings(const std::vector<double>& values,
                                   const std::function<std::optional<double>(double value)>& overlap) {
  std::vector<Grazing> found;
  if (values.empty()) return found;
  std::optional<double> before;
  double low = 0;
  for (std::size_t i = 0; i < values.size(); i += std::max<std::size_t>(1, (values.size() - 1) / samples)) {
    const auto now = overlap(values[i]);
    if (before && now && (*before < 0) != (*now < 0)) {
      double left = low, right = values[i];
      int steps = 0;
      for (; steps < most_halvings && right - left > resolution * std::max(std::abs(left), std::abs(right)); ++steps) {
        const double middle = 0.5 * (left + right);
        const auto there = overlap(middle);
        if (!there) break;
        ((*there < 0) == (*before < 0) ? left : right) = middle;
      }
      found.push_back({*before < 0, 0.5 * (left + right), left, right, steps});
    }
    before = now;
    low = values[i];
  }
  return found;
}

}  // namespace ricochet
