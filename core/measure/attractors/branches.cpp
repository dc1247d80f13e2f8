#include <algorithm>
#include <map>
#include <numeric>
#include <ricochet/measure/attractors/branches.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>

namespace ricochet {
namespace {

constexpr int kLongestAbsence = 4;

}  // namespace

std::vector<int> Branches::add(const std::vector<SettledSection>& attractors) {
  struct Pair {
    double distance;
    std::size_t branch, attractor;
  };
  std::vector<Pair> pairs;
  for (std::size_t b = 0; b < branches_.size(); ++b)
    for (std::size_t k = 0; k < attractors.size(); ++k) {
      if (!(branches_[b].last.motion == attractors[k].motion)) continue;
      const int away = values_ - branches_[b].seen - 1;
      if (away > kLongestAbsence) continue;
      const double near = relative_distance(branches_[b].last, attractors[k], rule_);
      if (near <= 1) pairs.push_back({near * (1 + 0.5 * away), b, k});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<int> out(attractors.size(), -1);
  std::vector<char> taken(branches_.size(), 0);
  for (const Pair& pair : pairs)
    if (!taken[pair.branch] && out[pair.attractor] < 0) {
      taken[pair.branch] = 1;
      out[pair.attractor] = static_cast<int>(pair.branch);
    }
  for (std::size_t k = 0; k < attractors.size(); ++k) {
    if (out[k] < 0) {
      out[k] = static_cast<int>(branches_.size());
      branches_.emplace_back();
    }
    branches_[static_cast<std::size_t>(out[k])] = {attractors[k], values_};
  }
  ++values_;
  return out;
}

std::vector<int> match_branches(const std::vector<CaseBranch>& branches, const std::vector<BranchPair>& pairs) {
  using Places = std::vector<std::pair<int, int>>;  // owner, value: sorted
  std::vector<std::size_t> parent(branches.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  std::vector<Places> places;
  for (const CaseBranch& branch : branches) {
    Places& own = places.emplace_back();
    for (const int value : branch.values) own.emplace_back(branch.owner, value);
  }
  const auto root = [&](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (!pairs[k].distances.empty())
      if (const double distance = lower_median(pairs[k].distances); distance <= 1) order.emplace_back(distance, k);
  std::sort(order.begin(), order.end());
  for (const auto& [distance, k] : order) {
    const std::size_t a = root(static_cast<std::size_t>(pairs[k].a)), b = root(static_cast<std::size_t>(pairs[k].b));
    if (a == b) continue;
    Places both;
    std::merge(places[a].begin(), places[a].end(), places[b].begin(), places[b].end(), std::back_inserter(both));
    if (std::adjacent_find(both.begin(), both.end()) != both.end()) continue;
    parent[b] = a;
    places[a] = std::move(both);
    places[b].clear();
  }
  std::map<std::size_t, int> known;
  std::vector<int> out;
  for (std::size_t k = 0; k < branches.size(); ++k)
    out.push_back(known.emplace(root(k), static_cast<int>(known.size())).first->second);
  return out;
}

}  // namespace ricochet
