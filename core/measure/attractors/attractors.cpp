#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <set>
#include <utility>

namespace ricochet {

namespace {

/// Sets that merge, each with the owners in it.
class Merging {
 public:
  explicit Merging(std::size_t count) : parent_(count), owners_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::set<int>& owners(std::size_t k) { return owners_[root(k)]; }
  std::size_t root(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void merge(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    if (a == b) return;
    parent_[b] = a;
    owners_[a].insert(owners_[b].begin(), owners_[b].end());
  }
  /// Set of each element, numbered from 0 in the order met.
  std::vector<int> labels() {
    std::vector<int> out;
    std::map<std::size_t, int> known;
    for (std::size_t k = 0; k < parent_.size(); ++k)
      out.push_back(known.emplace(root(k), static_cast<int>(known.size())).first->second);
    return out;
  }

 private:
  std::vector<std::size_t> parent_;
  std::vector<std::set<int>> owners_;
};

}  // namespace

double relative_distance(const SettledSection& a, const SettledSection& b, const LinkRule& rule) {
  if (!(a.motion == b.motion)) return std::numeric_limits<double>::infinity();
  if (a.cloud.empty() || b.cloud.empty()) return 0;
  const double null = std::max(a.cloud.null, b.cloud.null);
  return cloud_distance(a.cloud, b.cloud) / std::max(rule.cycle, rule.null_factor * null);
}

std::vector<int> cluster_starts(const std::vector<SettledSection>& sections, const LinkRule& rule) {
  Merging sets(sections.size());
  for (std::size_t i = 0; i < sections.size(); ++i)
    for (std::size_t j = i + 1; j < sections.size(); ++j)
      if (sets.root(i) != sets.root(j) && relative_distance(sections[i], sections[j], rule) <= 1) sets.merge(i, j);
  return sets.labels();
}

std::vector<int> match_owners(const std::vector<OwnedSection>& sections, const LinkRule& rule) {
  struct Pair {
    double distance;
    std::size_t a, b;
  };
  std::vector<Pair> pairs;
  Merging sets(sections.size());
  for (std::size_t i = 0; i < sections.size(); ++i) {
    sets.owners(i).insert(sections[i].owner);
    for (std::size_t j = i + 1; j < sections.size(); ++j) {
      if (sections[i].owner == sections[j].owner) continue;
      const double distance = relative_distance(*sections[i].section, *sections[j].section, rule);
      if (distance <= 1) pairs.push_back({distance, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  for (const Pair& pair : pairs) {
    if (sets.root(pair.a) == sets.root(pair.b)) continue;
    const std::set<int>&one = sets.owners(pair.a), &other = sets.owners(pair.b);
    if (std::none_of(one.begin(), one.end(), [&](int owner) { return other.count(owner) > 0; }))
      sets.merge(pair.a, pair.b);
  }
  return sets.labels();
}

Proportion wilson_interval(double share, double trials) {
  if (!(trials > 0)) return {};
  constexpr double z = 1.959963984540054;
  const double spread = z * z / trials, middle = (share + spread / 2) / (1 + spread);
  const double half = z / (1 + spread) * std::sqrt(share * (1 - share) / trials + spread / (4 * trials));
  // At 0 and 1 the interval ends there exactly; round-off must not say otherwise.
  return {share, std::clamp(middle - half, 0.0, share), std::clamp(middle + half, share, 1.0)};
}

int OrbitEnds::label(SettledSection section) {
  int label = static_cast<int>(met_.size());
  double nearest = 1;
  for (std::size_t k = 0; k < met_.size(); ++k)
    if (const double distance = relative_distance(met_[k], section, rule_); distance <= nearest) {
      nearest = distance;
      label = static_cast<int>(k);
    }
  if (label == static_cast<int>(met_.size())) met_.push_back(std::move(section));
  return label;
}

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
