#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <ricochet/measure/attractors/uncertainty_exponent.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

constexpr double saturated = 0.8;
constexpr std::size_t fewest_sizes = 3;

struct Size {
  double x = 0, y = 0, trust = 0;  // ln ε, ln f, relative error of f by counting
};

/// Cells by row; what lies outside is not known.
struct Grid {
  const std::vector<int>& labels;
  int columns, rows;
  int operator()(int i, int j) const {
    if (i < 0 || j < 0 || i >= columns || j >= rows) return -1;
    return labels[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)];
  }
  bool uncertain(int i, int j, int reach) const {
    const int own = (*this)(i, j);
    const auto differs = [&](int label) { return label >= 0 && label != own; };
    return differs((*this)(i - reach, j)) || differs((*this)(i + reach, j)) || differs((*this)(i, j - reach)) ||
           differs((*this)(i, j + reach));
  }
};

}  // namespace

std::optional<Interval> uncertainty_exponent(const std::vector<int>& labels, int columns, int rows) {
  if (columns < 1 || rows < 1 || labels.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("the labels do not fill the grid");
  const Grid grid{labels, columns, rows};
  const int dimensions = (columns > 1) + (rows > 1);
  const int side = columns == 1 ? rows : rows == 1 ? columns : std::min(columns, rows);
  const auto known = std::count_if(labels.begin(), labels.end(), [](int label) { return label >= 0; });
  std::vector<Size> sizes;
  for (int reach = 1; reach <= side / 4; reach *= 2) {
    long long uncertain = 0;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) uncertain += grid(i, j) >= 0 && grid.uncertain(i, j, reach);
    if (uncertain == 0) continue;
    const double share = static_cast<double>(uncertain) / static_cast<double>(known);
    if (share > saturated) break;
    const double apart = static_cast<double>(uncertain) / std::pow(2.0 * reach, dimensions);
    sizes.push_back({std::log(reach), std::log(share), 1 / std::sqrt(std::max(1.0, apart))});
  }
  if (sizes.size() < fewest_sizes) return std::nullopt;

  const double n = static_cast<double>(sizes.size());
  double mean_x = 0, mean_y = 0, sxx = 0, sxy = 0, squares = 0, counted = 0;
  for (const Size& s : sizes) mean_x += s.x / n, mean_y += s.y / n;
  for (const Size& s : sizes) sxx += (s.x - mean_x) * (s.x - mean_x), sxy += (s.x - mean_x) * (s.y - mean_y);
  const double slope = sxy / sxx;
  for (const Size& s : sizes) {
    squares += std::pow(s.y - mean_y - slope * (s.x - mean_x), 2);
    counted += std::pow((s.x - mean_x) / sxx * s.trust, 2);
  }
  const double student = boost::math::quantile(boost::math::students_t(n - 2), 0.975);
  const double half = std::hypot(student * std::sqrt(squares / (n - 2) / sxx), 1.96 * std::sqrt(counted));
  return Interval{slope, slope - half, slope + half};
}

}  // namespace ricochet
