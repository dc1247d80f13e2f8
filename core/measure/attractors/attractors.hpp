#pragma once
#include <ricochet/measure/attractors/point_clouds.hpp>
#include <ricochet/measure/orbits/motion_class.hpp>
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

}  // namespace ricochet
