#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/lane_groups.hpp>
#include <ricochet/measure/orbits/section_march.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/kinds/sweep/forcing.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What makes a scene of a sweep out of its case: scalars that change, and where it begins.
struct SceneVariant {
  std::vector<std::pair<std::string, double>> values;  ///< JSON pointer and value
  bool own_state = true;                               ///< in the case's own initial state; else at rest
};

/// One scene of a sweep, made ready.
struct ForcedScene {
  SceneVariant variant;
  Said refusal;           ///< why this one cannot be marched; "" when it can
  bool no_start = false;  ///< because its initial state lies beyond a stop
  int group = -1;         ///< of those that share one factorisation
  LaneSpec lane;          ///< with the scene's own initial state
  double pulsation = 0;
};

/// The scenes of one case of a sweep: the case at each value of its parameters. They are sorted into groups that march
/// as lanes of one factorisation (LaneGroups).
class ForcedScenes {
 public:
  ForcedScenes(const StudyCase& study_case, const Registry& registry);

  /// Prepares one more scene; its number is the count before. Refusals and bad values are kept, not thrown.
  int add(SceneVariant variant);
  /// The case with one parameter changed, in its own initial state or at rest in the laboratory frame.
  int add(const std::string& pointer, double value, bool own_state);

  const ForcedScene& operator[](int scene) const { return scenes_[static_cast<std::size_t>(scene)]; }
  int count() const { return static_cast<int>(scenes_.size()); }
  int groups() const { return groups_.count(); }
  /// The scene that began the first group, and with it chose the operator of all; −1: there is none.
  int reference_scene() const { return reference_; }

  /// What the scenes of a group share, as LaneGroups has it.
  const SemiDiscrete& problem(int group) const { return *groups_.problem(group); }
  std::shared_ptr<const SemiDiscrete> shared_problem(int group) const { return groups_.problem(group); }
  const StepPlan& plan(int group) const { return groups_.plan(group); }
  double step(int group) const { return groups_.step(group); }
  const std::vector<std::string>& notes(int group) const { return problem(group).notes; }
  const char* operator_chosen() const { return groups_.operator_chosen(); }
  const std::vector<LeftOut>& left_out(int group) const { return groups_.left_out(group); }
  /// Whether orbits march one by one and leave out steps.
  bool flies() const { return groups_.flies(); }
  double predicted_step_seconds(int group, int lanes) const { return groups_.predicted_step_seconds(group, lanes); }
  Program program(int group, std::vector<LaneSpec> lanes, int tangents = 0) const {
    return groups_.program(group, std::move(lanes), tangents);
  }
  LaneState carry(const LaneState& state, int from, int to) const { return groups_.carry(state, from, to); }

 private:
  const StudyCase& case_;
  const Registry& registry_;
  std::vector<ForcedScene> scenes_;
  LaneGroups groups_;
  int reference_ = -1;
  std::vector<Said> beyond_limit_;  // per group: why an explicit step of it is refused
};

/// Item and reason of what the integration of a case does without; tangents belong to the exponents, where these are
/// asked for.
std::vector<std::pair<std::string, std::string>> march_left_out(const ForcedScenes& scenes,
                                                                const StudyCase& study_case);

/// Makes room in a plan for the step of a case that steps by the forcing period.
void widen_steps(CasePlan& plan, const StudyCase& study_case);

/// What a plan or a record says of the integration of a case: its operator, what it does without, notes.
template <class PlanOrRecord>
void describe_march(PlanOrRecord& out, const ForcedScenes& scenes, const StudyCase& study_case) {
  out.operator_name = scenes.operator_chosen();
  out.left_out = march_left_out(scenes, study_case);
  out.notes = scenes.notes(0);
  if (std::string note = forcing_note(study_case.scene); !note.empty()) out.notes.push_back(std::move(note));
}

}  // namespace ricochet
