#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contact_solvers/circle_solver.hpp>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/scene/checks.hpp>

namespace ricochet {

ForceBeyond force_beyond(ContactLaw& law, const Parameters& parameters) {
  if (law.absent()) return [](double) { return true; };
  if (!law.reads()) return {};
  law.prepare(1, {&parameters, 1});
  return [&law](double depth) { return std::isfinite(law.potential({.depth = depth})); };
}

void check_between_stops(const std::vector<double>& x, const Eigen::VectorXd& u, const Eigen::VectorXd& lower,
                         const Eigen::VectorXd& upper, const std::string& pointer, const std::string& what,
                         const ForceBeyond& beyond, const std::vector<std::string>& names,
                         const std::vector<int>& circles) {
  const auto any_circle = [&](int row) { return std::find(circles.begin(), circles.end(), row) != circles.end(); };
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (any_circle(static_cast<int>(i))) {
      const StopCircle circle = StopCircle::of(lower, upper, static_cast<int>(i++));
      const double distance = circle.distance(u[row], u[row + 1]), over = distance - circle.radius;
      if (over <= 1e-12 * (std::abs(u[row]) + std::abs(u[row + 1]) + circle.radius) || (beyond && beyond(over)))
        continue;
      throw BeyondStop(pointer, fmt::format("{} is {:.6g} m from the centre of stop {}, beyond its radius {:.6g} m; "
                                            "expected a state between the stops, or a compliant law that lets points "
                                            "pass them",
                                            what, distance, names[static_cast<std::size_t>(row)], circle.radius));
    }
    const double over = u[row] - upper[row], under = lower[row] - u[row];
    const bool above = over > 1e-12 * (std::abs(u[row]) + std::abs(upper[row]));
    const bool below = under > 1e-12 * (std::abs(u[row]) + std::abs(lower[row]));
    if ((!above && !below) || (beyond && beyond(std::max(over, under)))) continue;
    const bool upper_one = above && over >= under;
    throw BeyondStop(pointer,
                     fmt::format("{} is {:.6g} m at {}, beyond the {} stop at {:.6g} m; expected a state "
                                 "between the stops, or a compliant law that lets points pass them",
                                 what, u[row], names.empty() ? fmt::format("x = {:.6g} m", x[i]) : "stop " + names[i],
                                 upper_one ? "upper" : "lower", upper_one ? upper[row] : lower[row]));
  }
}

}  // namespace ricochet
