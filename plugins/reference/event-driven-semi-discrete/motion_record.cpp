#include "motion_record.hpp"

#include <algorithm>
#include <ricochet/kernels/eigenvalues.hpp>

namespace ricochet::reference {
namespace {

// R with xᵀA x = |R x|², A positive semidefinite: a small energy is not the difference of large ones.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& A, const Eigen::VectorXd& scale) {
  const SymmetricModes eigen = symmetric_modes(scale.asDiagonal() * A * scale.asDiagonal());
  const double largest = eigen.values.size() ? eigen.values.tail(1)[0] : 0;
  const Eigen::VectorXd roots =
      (eigen.values.array() < 1e-14 * largest).select(0, eigen.values.cwiseMax(0).cwiseSqrt());
  return roots.asDiagonal() * eigen.vectors.transpose() * scale.cwiseInverse().asDiagonal();
}

}  // namespace

MotionRecord::MotionRecord(const ReferenceProblem& problem, const SampleGrid& grid, const LinearStructure& structure)
    : problem_(problem),
      grid_(grid),
      structure_(structure),
      mass_root_(square_root(structure.mass, structure.scale)),
      stiffness_root_(square_root(structure.stiffness, structure.scale)) {}

void MotionRecord::sample(const State& now, double impulse) {
  do sample_one(now, impulse);
  while (pending() && next() <= now.time);
}

void MotionRecord::sample_one(const State& now, double impulse) {
  const DiscreteProblem& discrete = *problem_.discrete;
  const double t = grid_.times[sampled_++], moved = support_at(problem_, t), rate = support_rate_at(problem_, t);
  double energy = 0.5 * ((mass_root_ * now.rate).squaredNorm() + (stiffness_root_ * now.place).squaredNorm());
  if (structure_.spring > 0) {
    const Eigen::VectorXd y = structure_.contact * now.place, lower = structure_.bound_at(1, t),
                          upper = structure_.bound_at(-1, t);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double depth = std::max({0.0, lower[i] - y[i], y[i] - upper[i]});
      energy += 0.5 * structure_.spring * depth * depth;
    }
  }
  motion.tip.push_back(discrete.tip.dot(now.place) + moved);
  motion.tip_velocity.push_back(discrete.tip.dot(now.rate) + rate);
  motion.energy.push_back(energy);
  motion.impulse.push_back(impulse);
  const auto put = [](std::vector<double>& out, const Eigen::VectorXd& values, double add) {
    for (const double value : values) out.push_back(value + add);
  };
  put(motion.displacement, discrete.places * now.place, moved);
  put(motion.strain, discrete.strains * now.place, 0);
  put(motion.velocity, discrete.places * now.rate, rate);
}

}  // namespace ricochet::reference
