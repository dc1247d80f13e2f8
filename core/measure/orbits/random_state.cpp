#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/measure/orbits/section_march.hpp>

namespace ricochet {
namespace {

struct Shape {
  Eigen::VectorXd nodal;  // displacement 1 of the tip, or where stops are
  double pulsation = 0;
};

std::vector<Shape> slow_shapes(const SemiDiscrete& problem, int count) {
  if (problem.dofs() == 1) {
    const double m = problem.inertia.factored() ? 1 : dense_mass(problem.inertia)(0, 0);
    const double k = problem.stiffness.coeff(0, 0);
    return {{Eigen::VectorXd::Ones(1), k > 0 && m > 0 ? std::sqrt(k / m) : problem.support.pulsation}};
  }
  const MarchModel model(std::make_shared<SemiDiscrete>(problem), true);
  const Eigen::VectorXd masses = model.inertia().mass.diagonal();
  std::vector<int> order(static_cast<std::size_t>(masses.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return masses[a] > masses[b]; });
  std::vector<Shape> shapes;
  for (const int mode : order) {
    if (static_cast<int>(shapes.size()) == count || masses[mode] <= 0) break;
    Eigen::VectorXd shape = model.to_nodal(Eigen::VectorXd::Unit(masses.size(), mode));
    double tip = (problem.tip * shape)[0];
    const double least = 1e-9 * shape.lpNorm<Eigen::Infinity>();
    // What the tip does not see, as motions across it, is measured where it meets stops.
    if (std::abs(tip) < least && problem.points() > 0) tip = (problem.contact * shape).lpNorm<Eigen::Infinity>();
    if (std::abs(tip) < least) continue;
    shapes.push_back({shape / tip, std::sqrt(model.stiffness().coeff(mode, mode) / masses[mode])});
  }
  return shapes;
}

}  // namespace

void set_random_state(LaneSpec& lane, const SemiDiscrete& problem, std::uint64_t seed, int number) {
  std::mt19937_64 random(seed * 1000003u + static_cast<std::uint64_t>(number));
  // Not std::uniform_real_distribution: its numbers differ between libraries.
  const auto uniform = [&] { return 2 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1; };
  const double clamp = lane.amplitude * std::sin(lane.phase);
  double room = std::numeric_limits<double>::infinity();
  const auto lift = [&](Eigen::Index i) { return clamp + problem.motions.point(static_cast<int>(i), 0); };
  for (Eigen::Index i = 0; i < lane.lower.size(); ++i)
    room = std::min({room, std::abs(lane.upper[i] - lift(i)), std::abs(lift(i) - lane.lower[i])});
  if (!std::isfinite(room)) room = lane.amplitude != 0 ? std::abs(lane.amplitude) : 1.0;
  lane.position.setZero(problem.dofs());
  lane.velocity.setZero(problem.dofs());
  double share = 1;
  for (const Shape& shape : slow_shapes(problem, 3)) {
    lane.position += share * room * uniform() * shape.nodal;
    lane.velocity += share * room * shape.pulsation * uniform() * shape.nodal;
    share /= 2;
  }
  const Eigen::VectorXd at = problem.contact * lane.position;
  double factor = 1;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const double limit = 0.95 * (at[i] > 0 ? lane.upper[i] - lift(i) : lift(i) - lane.lower[i]);
    // A stop that presses on the structure at rest leaves no room to keep to.
    if (limit > 0 && std::abs(at[i]) > limit) factor = std::min(factor, limit / std::abs(at[i]));
  }
  lane.position *= factor;
}

}  // namespace ricochet
