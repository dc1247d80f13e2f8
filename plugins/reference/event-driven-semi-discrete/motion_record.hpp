#pragma once
#include <ricochet/contract/reference.hpp>

#include "contact_phase.hpp"

namespace ricochet::reference {

/// The motion as it is read on the grid.
class MotionRecord {
 public:
  MotionRecord(const ReferenceProblem& problem, const SampleGrid& grid, const LinearStructure& structure);

  double end() const { return grid_.times.empty() ? 0 : grid_.times.back(); }
  /// Whether the grid asks for more, and for which time first.
  bool pending() const { return sampled_ < grid_.times.size(); }
  double next() const { return grid_.times[sampled_]; }
  /// Takes the next time of the grid, and all others up to that of the state; `impulse` so far, N s.
  void sample(const State& now, double impulse);

  /// ½ wᵀK w, J.
  double elastic_energy(const Eigen::VectorXd& place) const { return 0.5 * (stiffness_root_ * place).squaredNorm(); }

  SampledMotion motion;

 private:
  void sample_one(const State& now, double impulse);

  const ReferenceProblem& problem_;
  const SampleGrid& grid_;
  const LinearStructure& structure_;
  Eigen::MatrixXd mass_root_, stiffness_root_;
  std::size_t sampled_ = 0;
};

}  // namespace ricochet::reference
