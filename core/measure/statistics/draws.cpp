#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <ricochet/measure/statistics/draws.hpp>

namespace ricochet {

double half_interval_over_scatter(std::size_t draws) {
  const auto n = static_cast<double>(draws);
  constexpr double upper = 0.975;
  return boost::math::quantile(boost::math::students_t(n - 1), upper) / std::sqrt(n);
}

std::optional<double> half_interval(const std::vector<double>& draws) {
  if (draws.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(draws.size());
  const double mean = std::accumulate(draws.begin(), draws.end(), 0.0) / n;
  double squares = 0;
  for (const double one : draws) squares += (one - mean) * (one - mean);
  return half_interval_over_scatter(draws.size()) * std::sqrt(squares / (n - 1));
}

}  // namespace ricochet
