#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/scene/stop_parameters.hpp>

namespace ricochet {
namespace {

constexpr int most_closed_dofs = 160, most_single_points = 20;

}  // namespace

void StabilityPredictor::choose_sets() {
  if (law_.absent) return;
  std::vector<int> points;
  for (int i = 0; i < problem_->points(); ++i)
    if (std::isfinite(problem_->lower[i]) || std::isfinite(problem_->upper[i])) points.push_back(i);
  if (points.empty()) return;
  if (law_.evaluation && !law_.stiffness) {
    notes_.push_back("closed contact is not predicted: the law has no constant stiffness");
    return;
  }
  if (problem_->dofs() > most_closed_dofs) {
    notes_.push_back(
        fmt::format("closed contact is not predicted: the {} dofs are over {}", problem_->dofs(), most_closed_dofs));
    return;
  }
  const auto x = [&](int i) { return problem_->contact_x[static_cast<std::size_t>(i)]; };
  std::sort(points.begin(), points.end(), [&](int a, int b) { return x(a) > x(b); });
  const auto where = [&](int i) {
    return problem_->stops.empty() ? fmt::format("x = {:.6g} m", x(i))
                                   : "stop " + problem_->stops[static_cast<std::size_t>(i)];
  };
  const auto alone = [&](int i) { sets_.push_back({where(i), {i}}); };
  if (!problem_->clearances.empty()) return choose_around(points, where);
  if (points.size() == 1)
    sets_.push_back({"the contact point", points});
  else if (points.size() <= most_single_points)
    for (const int i : points) alone(i);
  else
    for (const int i : {points.front(), points[points.size() / 2]}) alone(i);
  if (points.size() > 1) sets_.push_back({fmt::format("all {} points", points.size()), points});
}

// Of clearances two sides beside each other close together at most. They hold both displacements, as others beside them
// would.
void StabilityPredictor::choose_around(const std::vector<int>& points, const std::function<std::string(int)>& where) {
  std::vector<int> together;
  int stops = 0;
  const bool few = points.size() <= most_single_points;
  for (const int i : points) {
    if (problem_->round(i)) continue;
    sets_.push_back({where(i), {i}});
    together.push_back(i);
    ++stops;
  }
  for (const Clearance& one : problem_->clearances) {
    const auto sides = static_cast<int>(one.angles.size());
    if (one.circle) {  // it pushes along one radius at a time
      for (const int axis : {0, 1})
        sets_.push_back({fmt::format("{}, along {}", where(one.first), axis == 0 ? "u₁" : "u₂"), {one.first + axis}});
      together.push_back(one.first);
      ++stops;
      continue;
    }
    for (int k = 0; k < sides; ++k)
      if (few || k == 0 || k == sides / 2)
        sets_.push_back({fmt::format("{}, side {}", where(one.first), k + 1), {one.first + k}});
    const std::vector<int> corner{one.first, one.first + 1};
    sets_.push_back({fmt::format("{}, a corner,", where(one.first)), corner});
    together.insert(together.end(), corner.begin(), corner.end());
    ++stops;
  }
  if (stops > 1) sets_.push_back({fmt::format("all {} stops", stops), together});
}

LinearLaw linear_law(ContactLaw& law, int points, const Parameters& parameters, const OwnParameters& stops) {
  LinearLaw out;
  out.absent = law.absent() || points == 0;
  if (out.absent) return out;
  prepare_law(law, points, std::span<const Parameters>(&parameters, 1), stops);
  out.evaluation = law.reads();
  out.stiffness = constant_stiffness(law);
  for (int i = 0; out.stiffness && sets_per_point(law, stops) && i < points; ++i) {
    const auto own = constant_stiffness(law, i);
    if (own)
      out.own.push_back(*own);
    else
      out.stiffness.reset();
  }
  return out;
}

}  // namespace ricochet
