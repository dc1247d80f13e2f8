#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/coincident_stops.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

constexpr double round_off = 1e-12;

bool close(double a, double b) {
  return std::abs(a - b) <= round_off * (std::abs(a) + std::abs(b));
}

// The largest entry of a row and where it stands; entries below round-off of it are none.
struct RowSize {
  int column = -1;
  double value = 0;
};

RowSize size_of(const SparseRows& rows, int i) {
  RowSize size;
  for (SparseRows::InnerIterator entry(rows, i); entry; ++entry)
    if (std::abs(entry.value()) > (1 + round_off) * std::abs(size.value))
      size = {static_cast<int>(entry.col()), entry.value()};
  return size;
}

/// c where row j is c times row i, and what lifts its point too; 0: it is no multiple.
double multiple(const SemiDiscrete& problem, int i, int j, double c) {
  const SparseRows &rows = problem.contact, difference = rows.row(j) - c * rows.row(i);
  const double size = std::abs(size_of(rows, j).value);
  for (SparseRows::InnerIterator entry(difference, 0); entry; ++entry)
    if (std::abs(entry.value()) > round_off * size) return 0;
  // The harmonic support lifts every point by the same.
  if (problem.support.amplitude != 0 && c != 1) return 0;
  if (problem.motions.empty()) return c;
  const auto lift_i = problem.motions.at_points.row(i), lift_j = problem.motions.at_points.row(j);
  return (lift_j - c * lift_i).cwiseAbs().maxCoeff() <= round_off * (1 + lift_j.cwiseAbs().maxCoeff()) ? c : 0;
}

/// A bound of one of the stops at a place, in the displacement of the first of them.
struct Bound {
  int point = 0;
  double value = 0;
  bool upper = false;  // whether it is the upper one of its own stop
};

/// Stops at one place: their points, and by what their displacement is that of the first.
struct SharedPlace {
  std::vector<std::pair<int, double>> points;

  // From the nearest one outwards.
  std::vector<Bound> bounds(const SemiDiscrete& problem, bool upper) const {
    std::vector<Bound> out;
    for (const auto& [point, factor] : points) {
      const bool own = upper == (factor > 0);
      const double value = (own ? problem.upper : problem.lower)[point] / factor;
      if (std::isfinite(value)) out.push_back({point, value, own});
    }
    std::stable_sort(out.begin(), out.end(),
                     [&](const Bound& a, const Bound& b) { return upper ? a.value < b.value : a.value > b.value; });
    return out;
  }
};

std::vector<SharedPlace> shared_places(const SemiDiscrete& problem) {
  std::vector<SharedPlace> places;
  // Rows that are multiples have their largest entry in one column, and as many entries.
  std::map<std::pair<int, Eigen::Index>, std::vector<std::size_t>> alike;
  for (int j = 0; j < problem.points(); ++j) {
    const RowSize size = size_of(problem.contact, j);
    if (size.column < 0) continue;
    std::vector<std::size_t>& known = alike[{size.column, problem.contact.row(j).nonZeros()}];
    const auto at = std::find_if(known.begin(), known.end(), [&](std::size_t place) {
      const int i = places[place].points.front().first;
      const double c = multiple(problem, i, j, size.value / size_of(problem.contact, i).value);
      if (c != 0) places[place].points.emplace_back(j, c);
      return c != 0;
    });
    if (at != known.end()) continue;
    known.push_back(places.size());
    places.push_back({{{j, 1.0}}});
  }
  std::erase_if(places, [](const SharedPlace& place) { return place.points.size() < 2; });
  return places;
}

}  // namespace

std::optional<Refusal> keep_nearest_bounds(SemiDiscrete& problem) {
  const auto name = [&](const Bound& bound) { return problem.stops[static_cast<std::size_t>(bound.point)]; };
  if (problem.stops.empty()) return std::nullopt;
  std::set<std::string> said;  // the sides of a clearance say it once
  for (const SharedPlace& place : shared_places(problem)) {
    const std::vector<Bound> lower = place.bounds(problem, false), upper = place.bounds(problem, true);
    if (!lower.empty() && !upper.empty() && lower.front().value > upper.front().value &&
        !close(lower.front().value, upper.front().value))
      throw BeyondStop("/scene/stops",
                       fmt::format("stops {} and {} are at one place, with the lower bound {:.6g} m above the upper "
                                   "bound {:.6g} m. Expected lower ≤ upper, or a compliant law that lets points pass "
                                   "both",
                                   name(lower.front()), name(upper.front()), lower.front().value, upper.front().value));
    for (const std::vector<Bound>* side : {&lower, &upper}) {
      if (side->size() < 2) continue;
      const Bound &first = (*side)[0], &second = (*side)[1];
      if (close(first.value, second.value))
        return Refusal{ricochet::said(
            "stops {} and {} have one bound at one place, and a rigid law knows only the sum of their forces: keep one "
            "of them, or use a compliant law",
            name(first), name(second))};
      for (auto behind = side->begin() + 1; behind != side->end(); ++behind) {
        (behind->upper ? problem.upper : problem.lower)[behind->point] = behind->upper ? infinity : -infinity;
        said.insert(fmt::format("stop {}: a rigid law never meets its {} bound, behind that of {} at one place",
                                name(*behind), behind->upper ? "upper" : "lower", name(first)));
      }
    }
  }
  problem.notes.insert(problem.notes.end(), said.begin(), said.end());
  return std::nullopt;
}

}  // namespace ricochet
