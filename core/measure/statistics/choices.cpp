#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/statistics/choices.hpp>
#include <set>

namespace ricochet {
namespace {

constexpr double kGood = 0.5, kEnough = 0.8, kGain = 0.2, kEqual = 1e-9;

double gini(const std::map<int, double>& counts, double total) {
  double squares = 0;
  for (const auto& [label, count] : counts) squares += count * count / (total * total);
  return 1 - squares;
}

std::size_t levels_of(const std::vector<std::string>& levels) {
  return std::set<std::string>(levels.begin(), levels.end()).size();
}

/// Share of an axis, plain and corrected for its levels; a corrected share of 0 where each case has its own level.
struct Rank {
  double share = 0, corrected = 0;
  std::size_t levels = 0;
};

Rank rank(const std::vector<int>& labels, const std::vector<std::string>& levels) {
  Rank out{explained_share(labels, levels), 0, levels_of(levels)};
  const double n = static_cast<double>(labels.size()), count = static_cast<double>(out.levels);
  if (out.levels < labels.size()) out.corrected = 1 - (1 - out.share) * (n - 1) / (n - count);
  return out;
}

std::vector<std::string> both(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < a.size(); ++k) out.push_back(a[k] + '\n' + b[k]);
  return out;
}

}  // namespace

double explained_share(const std::vector<int>& labels, const std::vector<std::string>& levels) {
  std::map<int, double> all;
  std::map<std::string, std::map<int, double>> by_level;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    ++all[labels[k]];
    ++by_level[levels[k]][labels[k]];
  }
  const double total = static_cast<double>(labels.size()), whole = total > 0 ? gini(all, total) : 0;
  if (whole < kEqual) return 0;
  double within = 0;
  for (const auto& [level, counts] : by_level) {
    double size = 0;
    for (const auto& [label, count] : counts) size += count;
    within += size / total * gini(counts, size);
  }
  return std::clamp((whole - within) / whole, 0.0, 1.0);
}

DecidingChoice deciding_choice(const std::vector<int>& labels, const std::vector<ChoiceAxis>& axes) {
  std::vector<std::size_t> varying;
  std::vector<Rank> ranks(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    ranks[a] = rank(labels, axes[a].levels);
    if (ranks[a].levels > 1) varying.push_back(a);
  }
  DecidingChoice out;
  if (varying.empty() || std::set<int>(labels.begin(), labels.end()).size() < 2) return out;
  const auto by = [&](auto key) {
    return *std::min_element(varying.begin(), varying.end(), [&](std::size_t a, std::size_t b) {
      if (std::abs(key(ranks[a]) - key(ranks[b])) > kEqual) return key(ranks[a]) > key(ranks[b]);
      return ranks[a].levels < ranks[b].levels;
    });
  };
  std::size_t best = by([](const Rank& r) { return r.corrected; });
  double reached = ranks[best].corrected;
  if (reached < kGood) {
    best = by([](const Rank& r) { return r.share; });
    reached = std::max(0.0, ranks[best].corrected);
  }
  // A parameter that only says which method it belongs to gives way to the method.
  for (const std::size_t a : varying)
    if (axes[best].name.starts_with(axes[a].name + ".") && ranks[a].share >= ranks[best].share - kEqual) best = a;
  out = {axes[best].name, ranks[best].share, 0, {best}};
  if (reached < kEnough)
    for (std::size_t i = 0; i < varying.size(); ++i)
      for (std::size_t j = i + 1; j < varying.size(); ++j) {
        const ChoiceAxis &a = axes[varying[i]], &b = axes[varying[j]];
        const Rank pair = rank(labels, both(a.levels, b.levels));
        if (2 * pair.levels > labels.size() || pair.corrected < reached + kGain) continue;
        reached = pair.corrected;
        out = {a.name + " × " + b.name, pair.share, 0, {varying[i], varying[j]}};
      }
  for (const std::size_t a : varying) {
    if (std::find(out.axes.begin(), out.axes.end(), a) != out.axes.end()) continue;
    const std::size_t levels = levels_of(both(axes[out.axes[0]].levels, axes[a].levels));
    const bool relabels = levels == std::max(ranks[out.axes[0]].levels, ranks[a].levels);
    if (!relabels) out.second = std::max(out.second, ranks[a].share);
  }
  return out;
}

}  // namespace ricochet
