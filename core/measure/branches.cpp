#include <algorithm>
#include <limits>
#include <ricochet/measure/branches.hpp>

namespace ricochet {
namespace {

constexpr int kFirstCases = 3, kLongestAbsence = 4;

}  // namespace

double Branches::distance(const Branch& branch, const AttractorGroup& group) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (branch.last.kind != group.kind) return nearest;
  std::vector<double> common;
  for (const auto& [owner, section] : group.sections)
    if (const auto last = branch.last.sections.find(owner); last != branch.last.sections.end())
      common.push_back(relative_distance(last->second, section, rule_));
  if (!common.empty()) {
    const auto middle = common.begin() + static_cast<std::ptrdiff_t>((common.size() - 1) / 2);
    std::nth_element(common.begin(), middle, common.end());
    return *middle;
  }
  int one = 0;
  for (const auto& [owner, section] : group.sections) {
    if (++one > kFirstCases) break;
    int other = 0;
    for (const auto& [last_owner, last] : branch.last.sections) {
      if (++other > kFirstCases) break;
      nearest = std::min(nearest, relative_distance(last, section, rule_));
    }
  }
  return nearest;
}

std::vector<int> Branches::add(const std::vector<AttractorGroup>& groups) {
  struct Pair {
    double distance;
    std::size_t branch, group;
  };
  std::vector<Pair> pairs;
  for (std::size_t b = 0; b < branches_.size(); ++b)
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double near = distance(branches_[b], groups[g]);
      const int away = std::min(values_ - branches_[b].seen - 1, kLongestAbsence);
      if (near <= 1) pairs.push_back({near * (1 + 0.5 * away), b, g});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<int> identities(groups.size(), -1);
  std::vector<char> taken(branches_.size(), 0);
  for (const Pair& pair : pairs)
    if (!taken[pair.branch] && identities[pair.group] < 0) {
      taken[pair.branch] = 1;
      identities[pair.group] = static_cast<int>(pair.branch);
    }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (identities[g] < 0) {
      identities[g] = static_cast<int>(branches_.size());
      branches_.push_back({{groups[g].kind, {}}, values_});
    }
    Branch& branch = branches_[static_cast<std::size_t>(identities[g])];
    for (const auto& [owner, section] : groups[g].sections) branch.last.sections[owner] = section;
    branch.seen = values_;
  }
  ++values_;
  return identities;
}

}  // namespace ricochet
