#pragma once
#include <ricochet/measure/attractors/attractors.hpp>
#include <vector>

/// \file
/// Attractors along the parameter, first within a case, then over cases: identities that last.
///
/// Within a case an attractor moves little from one value of the parameter to the next, which tells it from the others.
/// Between cases the errors of both may displace it at every value; many values together tell it from another one. So
/// branches are followed case by case, and matched as wholes.
namespace ricochet {

/// Successive values of the parameter, and branches of cases against each other: a third of the spread.
constexpr LinkRule kAlongParameter{0.35, 2};

/// Follows the attractors of one case along rising values of the parameter. A section continues the branch of its class
/// whose last section is near: relative_distance() with kAlongParameter is at most 1, the nearest pairs first, each
/// branch in one section at most. A branch that has been away for up to four values may come back; it counts as
/// further, by half its distance per value. What continues no branch is born.
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

/// Identity of each branch over all cases, from 0 in the order met: branches whose median distance is at most 1 become
/// one, the nearest first, unless that would join two attractors that one case shows at one value.
std::vector<int> match_branches(const std::vector<CaseBranch>& branches, const std::vector<BranchPair>& pairs);

}  // namespace ricochet
