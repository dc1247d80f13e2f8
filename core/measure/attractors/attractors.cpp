#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <ricochet/measure/attractors/attractors.hpp>
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
  double threshold = rule.cycle;
  if (!a.cycle || !b.cycle) threshold = std::max(threshold, rule.null_factor * std::max(a.cloud.null, b.cloud.null));
  return cloud_distance(a.cloud, b.cloud) / threshold;
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

}  // namespace ricochet
