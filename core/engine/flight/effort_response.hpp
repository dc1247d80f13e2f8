#pragma once
#include <Eigen/Core>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// What an effort of 1 N along one row of modes does to a step, over modes with φᵀKφ = 1 and φᵀMφ = μ: the effort that
/// stage `stage` found `ago` steps before, as far as the stages of this step weigh it, the slots zero where it begins.
class EffortResponse {
 public:
  EffortResponse(const Program& program, int stage, int ago, const Eigen::VectorXd& row);

  /// Whether no stage of this step weighs it.
  bool none() const { return none_; }
  /// Σ_j c_j x_j + c_z z before stage `at` and with its unknown; `at` = number of stages: after the step. One per mode.
  Eigen::VectorXd of(int at, const Combination& c) const;
  /// The slots after the step, modes × slots.
  const Eigen::MatrixXd& change() const { return slots_.back(); }

 private:
  bool none_ = true;
  std::vector<Eigen::MatrixXd> slots_;    // before each stage, and after the last
  std::vector<Eigen::VectorXd> unknown_;  // of each stage
};

}  // namespace ricochet
