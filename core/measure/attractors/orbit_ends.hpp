#pragma once
#include <ricochet/measure/attractors/attractors.hpp>
#include <vector>

/// \file
/// Which orbits of one scene have the same end: the one rule by which a grid of initial states is refined, its basins
/// are told apart, and a map of them is drawn.
///
/// Two ends are the same where their classes are equal and relative_distance() by kSameScene is at most 1. So a motion
/// and its mirror image, x → −x, t → t + T/2, are one end. In a symmetric scene every motion that is not its own image
/// has one: both hit as often and as hard, only the sides are exchanged, and between their basins no answer changes
/// (does this state end in impacts, in which motion, how hard). A map that told them apart would show a boundary, often
/// a fractal one, where nothing is at stake. In a scene without that symmetry the image of a motion is none, and
/// nothing is folded.
///
/// Motions without contact are one, the linear response; their sections are left out and told by their class alone.
namespace ricochet {

/// Orbits of one scene: the transients of a grid's cells are shorter than those of a diagram, and leave more behind.
constexpr LinkRule kSameScene{0.05, 2};

/// Tells ends apart as they come.
class OrbitEnds {
 public:
  explicit OrbitEnds(const LinkRule& rule = kSameScene) : rule_(rule) {}
  /// Number of the end, from 0: that of the nearest of the ends met before, where it is the same, else a new one. A
  /// section that is not decided is an end like any other: whoever asks keeps it away.
  int label(SettledSection section);
  /// The section that was first met of each end.
  const std::vector<SettledSection>& met() const { return met_; }

 private:
  LinkRule rule_;
  std::vector<SettledSection> met_;
};

}  // namespace ricochet
