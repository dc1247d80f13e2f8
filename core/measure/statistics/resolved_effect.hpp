#pragma once
#include <optional>
#include <string>
#include <vector>

/// \file
/// Whether a difference between the levels of one choice is more than what the step and the mesh leave open.
namespace ricochet {

/// One level of a choice, all else being the same: the value v of its finest case, and by how much v moved when the
/// step, or the mesh, was refined last. All in one unit.
struct LevelValue {
  double value = 0;
  std::optional<double> step_move, mesh_move;  ///< ≥ 0; none where there is one step, or one mesh
  std::optional<double> sampling = {};         ///< half the interval of a mean over a window; none of other values
};

enum class EffectVerdict {
  not_observed,  ///< every value is within the floor
  no_matter,     ///< the difference and what is open are both within the threshold
  decides,       ///< the difference exceeds the threshold and twice what is open
  unresolved,    ///< none of these: what is open may be the difference
  untold,        ///< one step and one mesh: nothing tells what is open
};
/// "not observed", "does not matter", "decides", "not resolved", "not told".
const char* effect_word(EffectVerdict verdict);

struct ResolvedEffect {
  EffectVerdict verdict = EffectVerdict::not_observed;
  double effect = 0;                 ///< max v − min v over the levels
  std::optional<double> step, mesh;  ///< largest move over the levels
  std::optional<double> sampling;    ///< widest half interval of a mean over the levels
  std::size_t least = 0, most = 0;   ///< the levels of min v and max v
  /// What is open of v: the sum of the two largest moves and of the widest half interval.
  double open() const { return step.value_or(0) + mesh.value_or(0) + sampling.value_or(0); }
};

/// With levels v ± o, o what is open of a level (the move of its two finest steps plus that of its two finest meshes:
/// for an error that halves with the step, what is left of it), two levels are told apart where their intervals are
/// disjoint, at the latest where |v_a − v_b| > 2 max o. `threshold`: a difference that matters; `floor`: what round-off
/// may make of values, ≥ 0. At least one level.
ResolvedEffect resolved_effect(const std::vector<LevelValue>& levels, double threshold, double floor);

}  // namespace ricochet
