#pragma once
#include <ricochet/measure/attractors/point_clouds.hpp>
#include <ricochet/measure/orbits/regime.hpp>
#include <vector>

/// \file
/// Which settled sections show one attractor, at one value of the parameter.
///
/// Sections of different class (no contact, periodic 3, chaotic …) never do. Of one class, they are linked where their
/// distance (point_clouds.hpp, a mirror image folded onto its original) is at most a threshold,
///
///     cycles: c        others: max(c, f × the larger of the two nulls)
///
/// since two runs of one non-periodic attractor differ as much as the halves of one run do; f > 1 because a diagram
/// asks this thousands of times, and one answer in 20 would be wrong. Distances are in units of the spread of all
/// points of the study. Sections whose points are not known are told apart by their class alone.
namespace ricochet {

/// What one start settled on.
struct SettledSection {
  MotionClass motion;  ///< sections of different classes are different attractors
  bool cycle = false;  ///< a finite set of points
  SectionCloud cloud;
};

/// c and f above.
struct LinkRule {
  double cycle = 0, null_factor = 1;
};
/// Starts of one case: only what settling leaves.
constexpr LinkRule kSameRun{0.01, 1.5};
/// Cases against each other: the errors of step, mesh and contact move a section.
constexpr LinkRule kAcrossCases{0.1, 2};

/// Distance over threshold: linked where it is at most 1; infinite for different classes.
double relative_distance(const SettledSection& a, const SettledSection& b, const LinkRule& rule);

/// Attractor of each section, from 0 in the order met: single linkage.
std::vector<int> cluster_starts(const std::vector<SettledSection>& sections, const LinkRule& rule = kSameRun);

/// A section with the case that shows it.
struct OwnedSection {
  int owner = 0;
  const SettledSection* section = nullptr;
};

/// Group of each section over all owners, from 0 in the order met: single linkage from the closest pair on, but two
/// sections of one owner (told apart by cluster_starts) never come into one group.
std::vector<int> match_owners(const std::vector<OwnedSection>& sections, const LinkRule& rule = kAcrossCases);

/// A share of `trials` with its 95 % interval (Wilson 1927, J. Am. Stat. Assoc. 22, 209–212). Trials may be effective
/// ones, not whole; {0, 0, 1} without any.
struct Proportion {
  double value = 0, low = 0, high = 1;
};
Proportion wilson_interval(double share, double trials);

// Which orbits of one scene have the same end: the one rule by which a grid of initial states is refined, its basins
// are told apart, and a map of them is drawn.
//
// Two ends are the same where their classes are equal and relative_distance() by kSameScene is at most 1. So a motion
// and its mirror image, x → −x, t → t + T/2, are one end. In a symmetric scene every motion that is not its own image
// has one: both hit as often and as hard, only the sides are exchanged, and between their basins no answer changes
// (does this state end in impacts, in which motion, how hard). A map that told them apart would show a boundary, often
// a fractal one, where nothing is at stake. In a scene without that symmetry the image of a motion is none, and
// nothing is folded.
//
// Motions without contact are one, the linear response; their sections are left out and told by their class alone.

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
