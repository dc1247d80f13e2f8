#pragma once
#include <map>
#include <ricochet/measure/attractors.hpp>
#include <vector>

/// \file
/// Attractors along the parameter: identities that last.
namespace ricochet {

/// One attractor at one value: the cases that show it, each with its section.
struct AttractorGroup {
  int kind = 0;
  std::map<int, SettledSection> sections;  ///< by case
};

/// Follows groups along rising values of the parameter. A group continues a branch of its kind whose last sections are
/// near its own: the median over the cases that both have of relative_distance() with kAlongParameter is at most 1;
/// where they share no case, the least over the first cases of each. Every branch continues in one group at most, the
/// nearest pairs first; a branch that has been away for some values counts as further (by half its distance per value,
/// up to four), but may come back. What continues no branch is born.
class Branches {
 public:
  explicit Branches(const LinkRule& rule = kAlongParameter) : rule_(rule) {}
  /// Identities (from 0, in the order of birth) of the groups at the next value.
  std::vector<int> add(const std::vector<AttractorGroup>& groups);
  int count() const { return static_cast<int>(branches_.size()); }

 private:
  struct Branch {
    AttractorGroup last;  ///< newest section of each case
    int seen = 0;         ///< value at which it was last met
  };
  double distance(const Branch& branch, const AttractorGroup& group) const;

  LinkRule rule_;
  std::vector<Branch> branches_;
  int values_ = 0;
};

}  // namespace ricochet
