#include "runners/asks/pairs.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet::asks {

std::optional<double> Pair::share() const {
  // A value that is round-off, or within what is open of it, is no measure of a difference.
  if (std::abs(base) <= std::max(first->floor, second->floor)) return std::nullopt;
  return difference / std::abs(base);
}

std::optional<double> Pair::share_u() const {
  if (!u || !share()) return std::nullopt;
  return *u / std::abs(base);
}

std::optional<Pair> pair_of(const Point& first, const Point& second) {
  if (!first.finest || !second.finest) return std::nullopt;
  std::map<Size, std::map<std::string, double>> differences;
  std::optional<Size> finest;
  for (const auto& [size, by_seed] : first.values) {
    const auto other = second.values.find(size);
    if (other == second.values.end()) continue;
    for (const auto& [seed, value] : by_seed)
      if (const auto match = other->second.find(seed); match != other->second.end())
        differences[size][seed] = match->second - value;
    if (differences.contains(size) &&
        (!finest || size.second > finest->second || (size.second == finest->second && size.first < finest->first)))
      finest = size;
  }
  if (!finest) return std::nullopt;
  Pair out{&first, &second};
  const auto& draws = differences.at(*finest);
  out.seeds = draws.size();
  std::map<Size, std::map<std::string, double>> halves;
  for (const auto& [seed, difference] : draws) {
    out.base += first.values.at(*finest).at(seed) / static_cast<double>(draws.size());
    const auto half = [&](const Point& point) -> std::optional<double> {
      const auto sized = point.halves.find(*finest);
      if (sized == point.halves.end()) return std::nullopt;
      const auto own = sized->second.find(seed);
      return own == sized->second.end() ? std::nullopt : std::optional(own->second);
    };
    // Means of two motions under one load: no surer than if they were drawn apart.
    const auto a = half(first), b = half(second);
    if (a && b) halves[*finest][seed] = std::hypot(*a, *b);
  }
  const double floor = std::max(first.floor, second.floor);
  const bool has_step = first.estimate && first.estimate->has_step;
  const Estimate estimate = estimate_of(differences, halves, *finest, limits_at(differences, *finest, floor), has_step);
  out.difference = estimate.value;
  out.unknown = estimate.grows ? "the difference grows without bound" : estimate.unknown();
  if (out.unknown.empty()) out.u = estimate.u();
  // A single size on both sides, and nothing drawn: nothing is known of the difference.
  if (out.unknown.empty() && !out.u && !has_step) out.u = floor;
  if (out.u) *out.u = std::max(*out.u, floor);
  // Never less sure than both together.
  if (out.u && first.estimate && second.estimate && first.estimate->u() && second.estimate->u())
    out.u = std::min(*out.u, std::max(floor, *first.estimate->u() + *second.estimate->u()));
  return out;
}

}  // namespace ricochet::asks
