#include "runners/asks/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace ricochet::asks {
namespace {

/// u of a difference, at least `floor`. `both`: what is open of the two together; no difference is less sure than that,
/// even one that still grows. Nothing where it is not known. `disproved`: whether another scheme disproves what
/// refinement tells of one of the two; it then tells nothing of their difference.
std::optional<double> left_open(const Estimate& estimate, const std::optional<double>& both, double floor,
                                bool disproved, bool doubted) {
  if (!estimate.unknown().empty()) return std::nullopt;
  if (disproved && both) return std::max(*both, floor);
  // Of a single size on both sides, and nothing drawn, nothing is known.
  std::optional<double> u =
      estimate.grows ? std::nullopt : std::optional((doubted ? estimate.doubted_u() : estimate.u()).value_or(0));
  if (both) u = std::min(u.value_or(*both), *both);
  return u ? std::optional(std::max(*u, floor)) : std::nullopt;
}

std::string why_not(const Estimate& estimate) {
  return estimate.grows ? "the difference grows without bound" : estimate.unknown();
}

/// Where one value or both lie beyond their ranges: by how much they differ at least.
Pair pair_beyond(const Point& first, const Point& second) {
  const Estimate &a = *first.estimate, &b = *second.estimate;
  Pair out{&first, &second};
  out.base = a.value;
  out.difference = b.value - a.value;
  out.least = true;
  const Estimate &known = a.beyond ? b : a, &least = a.beyond ? a : b;
  if (known.beyond || !(least.value > known.high()) || a.value <= 0)
    out.unknown = known.beyond ? "both lie beyond the range" : "one lies beyond the range";
  else
    out.share = (a.beyond ? b.high() - a.value : b.value - a.high()) / a.value;
  return out;
}

using Common = std::map<Size, std::map<std::string, double>>;  // sizes and draws that both have

/// Whether the values of a point fall with a refinement as what converges to zero does, from the coarsest size and from
/// the last but one to the finest.
bool falls(const Point& point, const Common& common, const Size& finest, bool steps) {
  std::map<double, double> along;  // by the size, the finest first
  for (const auto& [size, by_seed] : common) {
    if (steps ? size.second != finest.second : size.first != finest.first) continue;
    double& most = along[steps ? size.first : 1 / size.second];
    for (const auto& [seed, difference] : by_seed) most = std::max(most, std::abs(point.values.at(size).at(seed)));
  }
  const auto converges = [&](const auto& coarser) {
    return along.begin()->second < coarser.second * std::pow(along.begin()->first / coarser.first, lowest_order);
  };
  return along.size() > 1 && converges(*std::next(along.begin())) && converges(*along.rbegin());
}

/// Pair::apart, of these sizes.
bool are_apart(const Point& first, const Point& second, const Common& common, const Size& finest) {
  constexpr double times = 10;
  double least[2] = {INFINITY, INFINITY}, most[2] = {0, 0};
  for (const auto& [size, by_seed] : common)
    for (const auto& [seed, difference] : by_seed)
      for (const int side : {0, 1}) {
        const double value = std::abs((side == 0 ? first : second).values.at(size).at(seed));
        least[side] = std::min(least[side], value);
        most[side] = std::max(most[side], value);
      }
  const int larger = least[0] > least[1] ? 0 : 1;
  const Point& one = larger == 0 ? first : second;
  return common.size() > 1 && least[larger] > times * std::max({most[1 - larger], first.floor, second.floor}) &&
         !falls(one, common, finest, true) && !falls(one, common, finest, false);
}

}  // namespace

std::optional<Pair> pair_of(const Point& first, const Point& second) {
  if (!first.finest || !second.finest) return std::nullopt;
  if (first.estimate && second.estimate && (first.estimate->beyond || second.estimate->beyond))
    return pair_beyond(first, second);
  std::map<Size, std::map<std::string, double>> differences;
  std::optional<Size> finest;
  for (const auto& [size, by_seed] : first.values) {
    const auto other = second.values.find(size);
    if (other == second.values.end()) continue;
    for (const auto& [seed, value] : by_seed)
      if (const auto match = other->second.find(seed); match != other->second.end())
        differences[size][seed] = match->second - value;
    if (differences.contains(size) && (!finest || finer(size, *finest))) finest = size;
  }
  if (!finest) return std::nullopt;
  Pair out{&first, &second};
  const auto& draws = differences.at(*finest);
  std::map<Size, std::map<std::string, double>> halves;
  for (const auto& [seed, difference] : draws) {
    out.base += first.values.at(*finest).at(seed) / static_cast<double>(draws.size());
    const auto half = [&, of_seed = seed](const Point& point) -> std::optional<double> {
      const auto sized = point.halves.find(*finest);
      if (sized == point.halves.end()) return std::nullopt;
      const auto own = sized->second.find(of_seed);
      return own == sized->second.end() ? std::nullopt : std::optional(own->second);
    };
    // One draw: no surer than if the two were drawn apart. Of several, differences under one load tell.
    const auto a = half(first), b = half(second);
    // What is the same to the last bit, interval and all, is one draw.
    const bool same = difference == 0 && a == b;
    if (a && b && draws.size() == 1) halves[*finest][seed] = same ? 0 : std::hypot(*a, *b);
  }
  const double floor = std::max(first.floor, second.floor);
  out.identical =
      differences.size() > 1 && std::abs(out.base) > floor && first.halves == second.halves &&
      std::all_of(differences.begin(), differences.end(), [](const auto& sized) {
        return std::all_of(sized.second.begin(), sized.second.end(), [](const auto& one) { return one.second == 0; });
      });
  out.apart = are_apart(first, second, differences, *finest);
  const bool has_step = first.estimate && first.estimate->has_step;
  const auto own_u = [&](const Point& point, bool doubted) -> std::optional<double> {
    if (point.finest != finest || !point.estimate || !point.estimate->has_interval()) return std::nullopt;
    return doubted ? point.estimate->doubted_u() : point.estimate->u();
  };
  const auto both = [&](double weight_of_first, double unit, bool doubted) -> std::optional<double> {
    const std::optional<double> of_first = own_u(first, doubted), of_second = own_u(second, doubted);
    if (!of_first || !of_second) return std::nullopt;
    return (*of_second + weight_of_first * *of_first) / unit;
  };
  const Errors errors = std::max(first.errors, second.errors);
  const Estimate estimate =
      estimate_of(differences, halves, *finest, limits_at(differences, *finest, floor, errors), has_step);
  out.difference = estimate.value;
  out.one_limit = !first.limit.empty() && first.limit == second.limit;
  const bool disproved =
      (first.estimate && first.estimate->disproved) || (second.estimate && second.estimate->disproved);
  const auto open_of = [&](const Estimate& one, const std::optional<double>& of_both, double least, bool doubted) {
    std::optional<double> u = left_open(one, of_both, least, disproved, doubted);
    if (u && out.one_limit) u = std::max(*u, std::abs(one.value));
    return u;
  };
  out.u = open_of(estimate, both(1, 1, false), floor, false);
  out.u_most = open_of(estimate, both(1, 1, true), floor, true);
  if (!out.u) out.unknown = why_not(estimate);
  // What is not told from zero is no base of shares.
  if (std::abs(out.base) <= std::max(floor, own_u(first, false).value_or(0))) return out;
  // Both may move with the step while one stays the same share of the other.
  std::map<Size, std::map<std::string, double>> shares, share_halves;
  for (const auto& [size, by_seed] : differences) {
    const std::map<std::string, double>& firsts = first.values.at(size);
    double base = 0, mean = 0;
    for (const auto& [seed, difference] : by_seed) {
      base += firsts.at(seed) / static_cast<double>(by_seed.size());
      mean += difference / static_cast<double>(by_seed.size());
    }
    if (std::abs(base) <= floor) continue;
    // The ratio R of means; its scatter is that of (D − R B)/B̄ to first order: what is the same share of each is none.
    const double ratio = mean / base;
    for (const auto& [seed, difference] : by_seed)
      shares[size][seed] = by_seed.size() == 1 ? difference / std::abs(base)
                                               : (mean + difference - ratio * firsts.at(seed)) / std::abs(base);
    if (const auto own = halves.find(size); own != halves.end())
      for (const auto& [seed, half] : own->second) share_halves[size][seed] = half / std::abs(base);
  }
  const double round_off = floor / std::abs(out.base);
  const Estimate share =
      estimate_of(shares, share_halves, *finest, limits_at(shares, *finest, round_off, errors), has_step);
  out.share = share.value;
  out.share_u = open_of(share, both(1 + std::abs(share.value), std::abs(out.base), false), round_off, false);
  out.share_most = open_of(share, both(1 + std::abs(share.value), std::abs(out.base), true), round_off, true);
  out.motion = share.unsettled();
  for (const Point* point : {&first, &second})
    if (out.motion.empty() && point->estimate) out.motion = point->estimate->unsettled();
  out.unknown = out.share_u ? "" : why_not(share);
  return out;
}

}  // namespace ricochet::asks
