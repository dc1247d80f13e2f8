#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/compile.hpp>
#include <ricochet/measure/orbits/section_march.hpp>
#include <string>
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// One scene of a sweep, made ready.
struct ForcedScene {
  std::string refusal;  ///< why this one cannot be marched; "" when it can
  int group = -1;       ///< of those that share one factorisation
  LaneSpec lane;        ///< with the scene's own initial state
  double pulsation = 0;
};

/// The scenes of one case of a sweep: the case at each value of its parameters, sorted into groups that march as lanes
/// of one factorisation (same matrices, same step, same plan; amplitude, phase, stops, initial state and the law's
/// per-lane parameters may differ).
class ForcedScenes {
 public:
  ForcedScenes(const StudyCase& study_case, const Registry& registry);
  ~ForcedScenes();

  /// Prepares one more scene; its number is the count before. Refusals and bad values are kept, not thrown.
  int add(const std::function<StudyCase()>& variant);
  /// The case with one parameter changed, in its own initial state or at rest in the laboratory frame.
  int add(const std::string& pointer, double value, bool own_state);

  const ForcedScene& operator[](int scene) const { return scenes_[static_cast<std::size_t>(scene)]; }
  int count() const { return static_cast<int>(scenes_.size()); }
  int groups() const { return static_cast<int>(groups_.size()); }

  /// What the scenes of a group share.
  const SemiDiscrete& problem(int group) const;
  std::shared_ptr<const SemiDiscrete> shared_problem(int group) const;
  const StepPlan& plan(int group) const;
  double step(int group) const;
  const std::vector<std::string>& notes(int group) const;
  const char* operator_chosen() const;
  std::vector<LeftOut> left_out(int group) const;
  /// Seconds per step of a block of `lanes`, as predicted.
  double predicted_step_seconds(int group, int lanes) const;

  /// A program for these lanes, with `tangents` columns each. The operator is the same for all programs of the case, so
  /// that states are in the same coordinates and bits do not depend on the number of lanes.
  Program program(int group, std::vector<LaneSpec> lanes, int tangents = 0) const;

  /// A state of one group in the coordinates and slots of another: displacements as they are, velocities kept while
  /// the step changes.
  LaneState carry(const LaneState& state, int from, int to) const;

 private:
  struct Group;
  int group_of(std::unique_ptr<Group> candidate);

  const StudyCase& case_;
  const Registry& registry_;
  std::vector<ForcedScene> scenes_;
  std::vector<std::unique_ptr<Group>> groups_;
};

}  // namespace ricochet
