#include <algorithm>
#include <cmath>
#include <ricochet/measure/stability/grazing.hpp>

namespace ricochet {
namespace {

constexpr std::size_t looks = 16;  // from one to the next over the values
constexpr int most_halvings = 60;
constexpr double resolution = 1e-12;  // relative

}  // namespace

std::vector<Grazing> find_grazings(const std::vector<double>& values,
                                   const std::function<std::optional<double>(double value)>& overlap) {
  std::vector<Grazing> found;
  if (values.empty()) return found;
  std::optional<double> before;
  double low = 0;
  for (std::size_t i = 0; i < values.size(); i += std::max<std::size_t>(1, (values.size() - 1) / looks)) {
    const auto now = overlap(values[i]);
    if (before && now && (*before < 0) != (*now < 0)) {
      double left = low, right = values[i];
      int steps = 0;
      for (; steps < most_halvings && right - left > resolution * std::max(std::abs(left), std::abs(right)); ++steps) {
        const double middle = 0.5 * (left + right);
        const auto there = overlap(middle);
        if (!there) break;
        ((*there < 0) == (*before < 0) ? left : right) = middle;
      }
      found.push_back({*before < 0, 0.5 * (left + right), left, right, steps});
    }
    before = now;
    low = values[i];
  }
  return found;
}

}  // namespace ricochet
