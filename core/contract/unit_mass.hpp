#pragma once
#include <algorithm>
#include <cmath>
#include <ricochet/contract/step_plan.hpp>
#include <vector>

namespace ricochet {

/// A free unit mass (M = 1, C = K = 0) that a plan marches: what the plan's numbers mean, apart from any structure.
struct UnitMass {
  std::vector<double> slots;

  /// From displacement and velocity, before the start rule.
  UnitMass(const StepPlan& plan, double displacement, double velocity);
  /// The unknown of a stage under a constant force and a weighted effort Σ π_k p₋ₖ (N), fed with w. It is 0 where S has
  /// no M.
  double unknown(const Stage& stage, double force, double effort, double w = 0) const;
  /// w of a stage under the effort ι p (N); 0 where it has no impulse, or R no M.
  static double jump(const Stage& stage, double effort);
  /// The slots after the stage, with its unknowns.
  void update(const Stage& stage, double z, double w = 0);
  /// Stages under a constant force and without contact.
  void advance(const std::vector<Stage>& stages, double force);
};

/// Σ_j c_j x_j + c_z z + c_w w.
double combined(const Combination& combination, const std::vector<double>& slots, double z = 0, double w = 0);

}  // namespace ricochet

/// Free masses that are not pushed, marched by a plan; for the sources of stage_facts.hpp.
namespace ricochet::free_motion {

/// Round-off of a few dozen steps in numbers of order one.
constexpr double round_off = 1e-9;

inline bool is_zero(double x) {
  return std::abs(x) < round_off;
}

/// Levels and weights are mostly simple fractions, found here by arithmetic that rounds: the fraction is meant.
inline double simple(double x) {
  constexpr double denominator = 5040;
  const double nearest = std::round(x * denominator) / denominator;
  return std::abs(x - nearest) < round_off * std::max(1.0, std::abs(x)) ? nearest : x;
}

/// Whether every S and R of the plan has an M, or solves nothing: else nothing tells how far a step goes.
inline bool has_inertia(const StepPlan& plan) {
  const auto all = [](const std::vector<Stage>& stages) {
    return std::all_of(stages.begin(), stages.end(), [](const Stage& stage) {
      return (stage.matrix.M != 0 || (stage.matrix.C == 0 && stage.matrix.K == 0)) &&
             (!stage.impulse || stage.impulse->R.M != 0);
    });
  };
  return all(plan.start) && all(plan.stages);
}

/// Two masses, one at rest at 1 m, one at a speed that makes 1 m per step, stage by stage through one step.
class Uniform {
 public:
  Uniform(const StepPlan& plan, double h) : rest_(plan, 1, 0), moving_(plan, 0, 1), h_(h) {}
  explicit Uniform(const StepPlan& plan) : Uniform(plan, 0) {
    moving_.advance(plan.start, 0);
    rest_.advance(plan.start, 0);
    const double before = moving_.slots[0];
    UnitMass next = moving_;
    next.advance(plan.stages, 0);
    h_ = next.slots[0] - before;
  }
  double h() const { return h_; }
  const UnitMass& rest() const { return rest_; }
  const UnitMass& moving() const { return moving_; }

  /// Before the first stage of a set that begins now.
  void begin() { origin_ = moving_.slots[0]; }
  void measure(const Stage& stage) {
    rest_z_ = rest_.unknown(stage, 0, 0);
    moving_z_ = moving_.unknown(stage, 0, 0);
  }
  void pass(const Stage& stage) {
    rest_.update(stage, rest_z_);
    moving_.update(stage, moving_z_);
  }
  /// Where the position stands, in steps from begin().
  double place() const { return (moving_.slots[0] - origin_) / h_; }
  /// Σ of the combination's weights over positions.
  double weight(const Combination& c) const { return combined(c, rest_.slots, rest_z_); }
  /// Its first moment over time, in steps from begin().
  double moment(const Combination& c) const {
    return (combined(c, moving_.slots, moving_z_) - weight(c) * origin_) / h_;
  }
  /// What a rate gives at 1 m/s.
  double rate(const Combination& c) const { return combined(c, moving_.slots, moving_z_); }

 private:
  UnitMass rest_, moving_;
  double h_ = 0, origin_ = 0, rest_z_ = 0, moving_z_ = 0;
};

}  // namespace ricochet::free_motion
