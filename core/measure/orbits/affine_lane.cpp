#include <cmath>
#include <ricochet/measure/orbits/periodic_map.hpp>

namespace ricochet {

using Eigen::Index;

LaneSpec AffineLane::lane(double parameter) const {
  LaneSpec spec = origin;
  const double by = parameter - at;
  spec.amplitude += by * amplitude;
  spec.lower += by * lower;
  spec.upper += by * upper;
  return spec;
}

std::optional<AffineLane> affine_lane(const LaneSpec& first, double at_first, const LaneSpec& second,
                                      double at_second) {
  if (first.phase != second.phase || first.law.values() != second.law.values()) return std::nullopt;
  if (first.lower.size() != second.lower.size()) return std::nullopt;
  const double by = at_second - at_first;
  const auto slope = [&](double a, double b) { return a == b ? 0.0 : (b - a) / by; };
  AffineLane affine{first, at_first, slope(first.amplitude, second.amplitude), first.lower, first.upper};
  for (Index i = 0; i < first.lower.size(); ++i) {
    affine.lower[i] = slope(first.lower[i], second.lower[i]);
    affine.upper[i] = slope(first.upper[i], second.upper[i]);
  }
  if (!affine.lower.allFinite() || !affine.upper.allFinite()) return std::nullopt;
  return affine;
}

bool passes_through(const AffineLane& affine, const LaneSpec& lane, double at) {
  constexpr double round_off = 1e-12;
  const LaneSpec found = affine.lane(at);
  const auto same = [&](double a, double b) { return a == b || std::abs(a - b) <= round_off * std::abs(b); };
  if (lane.phase != found.phase || lane.law.values() != found.law.values() || !same(found.amplitude, lane.amplitude))
    return false;
  for (Index i = 0; i < lane.lower.size(); ++i)
    if (!same(found.lower[i], lane.lower[i]) || !same(found.upper[i], lane.upper[i])) return false;
  return true;
}

}  // namespace ricochet
