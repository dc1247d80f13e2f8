#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <ricochet/measure/orbits/stepped_map.hpp>
#include <string>

#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/sweep/forced_scenes.hpp"

namespace ricochet {

/// Whether the pointer names a length of the scene.
bool is_length(const std::string& pointer);

/// What a case of kind `continuation` maps: its scenes along the parameter, and what can be done with them.
class ContinuedMap {
 public:
  ContinuedMap(const StudyCase& study_case, const Registry& registry, const ContinuationPlan& plan);

  /// Why the case is refused; "" where it is not.
  const Said& refusal() const { return refusal_; }
  /// Why the map is not followed by pieces; "" where it is.
  const std::string& no_pieces() const { return no_pieces_; }
  /// Whether it is followed so.
  bool by_pieces() const { return no_pieces_.empty() && plan_.follow != Follow::steps; }
  /// Why orbits are not their own images; "" where they may be.
  const std::string& no_image() const { return no_image_; }

  /// The part of the range in which the scene is possible.
  double from() const { return from_; }
  double to() const { return to_; }
  /// Why not beyond the end of that part nearer to a value; "" where the study ends there.
  const std::string& impossible(double near) const { return impossible_[near - from_ > to_ - near]; }

  const ForcedScenes& scenes() const { return scenes_; }
  /// A scene at this value; −1 where it is refused, with the reason.
  int scene_at(double value, bool own_state, std::string& reason);
  /// A program of one lane.
  Program program(int scene) const;
  /// Half the distance between stops, or the distance to the only one, m; else the amplitude.
  double gap() const { return gap_; }
  /// Metres per unit of the parameter, in the length of a branch: 1 of a length, else the gap over the value.
  double parameter_metres() const { return metres_; }
  /// With the pulsation of the forcing at the first orbit.
  ArcUnits units() const { return {metres_, scenes_[reference_].pulsation}; }
  /// Unit of prominences: the gap for a length, else the value.
  double parameter_scale() const { return gap_ / metres_; }
  /// The map, which this outlives; only where no_pieces() is "".
  std::unique_ptr<PeriodicMap> map();
  /// The map at any value, in the coordinates of one; this outlives it. Branches have those of `reference_at`.
  SteppedMap stepped_map(double at);
  double reference_at() const { return reference_at_; }

 private:
  void check_class(int scene);
  void check_kernel(int scene);
  void check_tangents();
  double possible_end(double end, std::string& impossible);
  void check_ends();
  bool affine_loads(int low, int middle, int high);
  void check_image(int scene);

  const StudyCase& case_;
  const ContinuationPlan& plan_;
  ForcedScenes scenes_;
  Said refusal_;
  std::string no_pieces_, no_image_;
  int reference_ = -1, origin_ = -1;  // scenes: that of an orbit, and the one that lanes begin with
  bool moves_loads_ = false, rebounds_ = false;
  std::map<double, int> marched_;  // scenes by value
  std::optional<AffineLane> lanes_;
  double gap_ = 1, metres_ = 1, reference_at_ = 0, from_ = 0, to_ = 0;
  std::array<std::string, 2> impossible_;  // at the ends
};

}  // namespace ricochet
