#pragma once
#include <functional>
#include <map>
#include <memory>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/marcher.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// A problem with its plan and law: one scene of many, to be sorted.
struct LaneCandidate {
  std::shared_ptr<const SemiDiscrete> problem;
  StepPlan plan;
  double h = 0;                                  ///< s
  LaneSpec lane;                                 ///< with the scene's own initial state
  std::map<std::string, ParameterValue> scheme;  ///< its parameters
  std::map<std::string, ParameterValue> law;     ///< those that all lanes share
  std::function<std::unique_ptr<ContactLaw>()> make_law;
  std::function<std::unique_ptr<FrictionLaw>()> make_friction = {};  ///< null: nothing rubs
  std::map<std::string, ParameterValue> friction = {};               ///< its parameters
};

/// Scenes sorted into groups that march as lanes of one factorisation: same matrices, same step, same scheme and law.
/// Amplitude, phase, stops, friction, initial state and the law's per-lane parameters may differ. The operator is
/// chosen with the first group, for a block of eight lanes and a long integration. All programs have the same one.
/// States are thus in the same coordinates, and results do not depend bitwise on the number of lanes.
class LaneGroups {
 public:
  /// `way`: whether orbits march as lanes, or one by one and leave out steps (automatic: what is expected to cost
  /// less).
  explicit LaneGroups(MarchWay way = MarchWay::every_step);
  ~LaneGroups();

  /// The group of a scene, a new one where it fits none. Throws the Refusal of compile().
  int add(LaneCandidate candidate);
  int count() const { return static_cast<int>(groups_.size()); }

  /// What the scenes of a group share.
  std::shared_ptr<const SemiDiscrete> problem(int group) const;
  const StepPlan& plan(int group) const;
  double step(int group) const;
  const char* operator_chosen() const;
  const std::vector<LeftOut>& left_out(int group) const;
  /// Whether a program of one lane without tangents leaves out steps: lanes then march one by one.
  bool flies() const;
  /// Seconds per step of a block of `lanes`, as predicted.
  double predicted_step_seconds(int group, int lanes) const;

  /// A program for these lanes, with `tangents` columns each. Throws the Refusal of compile().
  Program program(int group, std::vector<LaneSpec> lanes, int tangents = 0) const;

  /// A state of one group in the coordinates and slots of another: displacements as they are, velocities kept while
  /// the step changes.
  LaneState carry(const LaneState& state, int from, int to) const;

 private:
  struct Group;
  bool try_flights(const LaneCandidate& candidate, Group& group) const;

  MarchWay way_;
  std::vector<std::unique_ptr<Group>> groups_;
};

}  // namespace ricochet
