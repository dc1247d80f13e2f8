#pragma once
#include <array>
#include <cstddef>
#include <ricochet/measure/orbits/regime.hpp>
#include <span>
#include <vector>

/// \file
/// Which settled sections show one attractor, at one value of the parameter.
///
/// Sections of different class (no contact, periodic 3, chaotic …) never do. Sections of one class are linked where
/// their distance is at most a threshold. The distance is cloud_distance(), a mirror image folded onto its original.
///
///     max(c, f × the larger of the two nulls)
///
/// The nulls enter because two runs of one non-periodic attractor differ as much as the halves of one run do. Two runs
/// of one cycle differ by what their steps leave open of it, which is its null. The factor f is above 1: a diagram asks
/// this thousands of times, and one answer in 20 would be wrong. Distances are in units of the spread of all points of
/// the study. Sections whose points are not known are told apart by their class alone.
namespace ricochet {

// Distances between sections of motions, as clouds of points in (displacement, velocity) made dimensionless.
//
// *Wasserstein-1*: clouds a (n points) and b (m points) are the measures Σδ_{a_i}/n and Σδ_{b_j}/m;
//
//     W(a, b) = min Σ_ij t_ij |a_i − b_j|,   t_ij ≥ 0, Σ_j t_ij = 1/n, Σ_i t_ij = 1/m
//
// (Euclidean norm). This is solved exactly where one of the two has at most 16 points and the other at most 64. The
// method is a transport of whole units by shortest augmenting paths (Tomizawa 1971; Edmonds and Karp 1972). Larger
// clouds are compared by slices (Rabin, Peyré, Delon and Bernot 2011). F_θ is the distribution of the points'
// projections on the direction θ. Eight directions are taken, evenly spread over a half turn from θ = π/16:
//
//     W(a, b) ≈ (π/2) mean_θ ∫ |F_θ^a(s) − F_θ^b(s)| ds
//
// This is exact on each direction. The factor makes the distance of a cloud to its translate the length of the
// translation. It is from 1.3 % below to 0.7 % above that length, by its direction. No pair's value exceeds
// 1.007 W(a, b).
//
// *Null*: a run of a non-periodic motion is at a distance from itself, because it is finite. The run is cut into 10
// blocks of successive points. Five of them are compared with the other five, in 19 draws; the first draw is the first
// half against the second. The null is the largest of these distances. W to another run of the same motion exceeds it
// once in 20. The Hausdorff distance exceeds its null once in five: it hangs on outliers, which all draws of a run
// share. Each half holds as many points as the clouds that are compared.

using CloudPoint = std::array<double, 2>;

/// W(a, b), exact. Neither may be empty.
double exact_wasserstein(std::span<const CloudPoint> a, std::span<const CloudPoint> b);
/// The sliced formula above. Neither may be empty.
double sliced_wasserstein(std::span<const CloudPoint> a, std::span<const CloudPoint> b);
/// The farthest that a point of one cloud is from the other cloud. Neither may be empty.
double hausdorff_distance(std::span<const CloudPoint> a, std::span<const CloudPoint> b);

/// A section made ready to be compared many times.
struct SectionCloud {
  std::vector<CloudPoint> points;    ///< at most 64, dimensionless: the points of a cycle, or an even sample of a run
  std::vector<CloudPoint> opposite;  ///< of the mirror image x → −x, t → t + T/2; empty where it is not known
  std::vector<double> slices, opposite_slices;  ///< sorted projections, direction by direction; empty for a cycle
  double null = 0;                              ///< W of the run against itself; of a cycle, what its steps leave open
  bool empty() const { return points.empty(); }
};

/// Prepares the section of a run. `run` and `opposite` (as long, or empty) are in SI units, in the order of time; they
/// are divided by `scale` here. `cycle` > 0: the section repeats after that many points, and the last ones stand for
/// it, at most 64; `open` (in the unit of displacements) is what its steps leave open of it. `cycle` = 0: an even
/// sample of at most 64 points stands for it. The sample is never more than half of the run, so that the null has
/// halves of that size. Points that are not finite are left out. Deterministic.
SectionCloud make_cloud(std::span<const CloudPoint> run, std::span<const CloudPoint> opposite, const CloudPoint& scale,
                        int cycle, double open = 0);

/// The points that are further apart than `tolerance` (dimensionless), in the order met: a periodic section whose
/// number of points is not known.
std::vector<CloudPoint> distinct_points(std::span<const CloudPoint> points, double tolerance);

/// Whether W between two clouds is computed exactly.
bool compared_exactly(const SectionCloud& a, const SectionCloud& b);
/// min(W(a, b), W(a, b′), W(a′, b)) with ′ the mirror image, where it is known: a motion and its mirror image are one.
/// 0 where both are empty, infinite where one is.
double cloud_distance(const SectionCloud& a, const SectionCloud& b);
/// The same of the Hausdorff distance.
double cloud_hausdorff(const SectionCloud& a, const SectionCloud& b);

/// What a run is from itself.
struct HalvesNull {
  double wasserstein = 0, hausdorff = 0;
};
/// The null of a run for both distances. A cycle's is the distance of its first to its last points: what is left of its
/// transient. {0, 0} where the run has fewer than 20 points (fewer than two cycles).
HalvesNull null_of_halves(std::span<const CloudPoint> run, const CloudPoint& scale, int cycle);

/// Standard deviation of each coordinate over all finite points, added one after the other. The largest magnitude takes
/// its place where the points do not spread; 1 where they are all zero or there are none.
class ScaleOfPoints {
 public:
  void add(const CloudPoint& point);
  CloudPoint scale() const;

 private:
  std::size_t count_ = 0;
  CloudPoint mean_{}, squares_{}, largest_{};
};

/// What one start settled on.
struct SettledSection {
  MotionClass motion;  ///< sections of different classes are different attractors
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

/// Group of each section over all owners, from 0 in the order met. Groups form by single linkage from the closest pair
/// on. Two sections of one owner (told apart by cluster_starts) never come into one group.
std::vector<int> match_owners(const std::vector<OwnedSection>& sections, const LinkRule& rule = kAcrossCases);

/// A share of `trials` with its 95 % interval (Wilson 1927, J. Am. Stat. Assoc. 22, 209–212). Trials may be effective
/// ones, not whole; {0, 0, 1} without any.
struct Proportion {
  double value = 0, low = 0, high = 1;
};
Proportion wilson_interval(double share, double trials);

// Which orbits of one scene have the same end. One rule refines a grid of initial states, tells its basins apart, and
// draws a map of them.
//
// Two ends are the same where their classes are equal and relative_distance() by kSameScene is at most 1. So a motion
// and its mirror image, x → −x, t → t + T/2, are one end. In a symmetric scene every motion that is not its own image
// has one. Both hit as often and as hard; only the sides are exchanged. Their basins give the same answers: whether a
// state ends in impacts, in which motion, how hard. A map that told them apart would show a boundary, often a fractal
// one, where nothing is at stake. In a scene without that symmetry the image of a motion is none, and nothing is
// folded.
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

// Attractors along the parameter, first within a case, then over cases: identities that last.
//
// Within a case an attractor moves little from one value of the parameter to the next, which tells it from the others.
// Between cases the errors of both may displace it at every value; many values together tell it from another one. So
// branches are followed case by case, and matched as wholes.

/// Successive values of the parameter, and branches of cases against each other: a third of the spread.
constexpr LinkRule kAlongParameter{0.35, 2};

/// Follows the attractors of one case along rising values of the parameter. A section continues the branch of its class
/// whose last section is near: relative_distance() with kAlongParameter is at most 1. The nearest pairs come first;
/// each branch continues in one section at most. A branch that has been away for up to four values may come back. It
/// counts as further, by half its distance per value. What continues no branch is born.
class Branches {
 public:
  explicit Branches(const LinkRule& rule = kAlongParameter) : rule_(rule) {}
  /// Branches (from 0, in the order of birth) of the attractors at the next value.
  std::vector<int> add(const std::vector<SettledSection>& attractors);
  int count() const { return static_cast<int>(branches_.size()); }

 private:
  struct Branch {
    SettledSection last;
    int seen = 0;  ///< value at which it was last met
  };

  LinkRule rule_;
  std::vector<Branch> branches_;
  int values_ = 0;
};

/// A branch of one case, with the values of the parameter (indices, ascending) at which it was met.
struct CaseBranch {
  int owner = 0;
  std::vector<int> values;
};

/// Two branches of different cases, with their relative distances where both were met.
struct BranchPair {
  int a = 0, b = 0;  ///< indices
  std::vector<double> distances;
};

/// Identity of each branch over all cases, from 0 in the order met. Branches whose median distance is at most 1 become
/// one, the nearest first. They stay apart where that would join two attractors that one case shows at one value.
std::vector<int> match_branches(const std::vector<CaseBranch>& branches, const std::vector<BranchPair>& pairs);

}  // namespace ricochet
