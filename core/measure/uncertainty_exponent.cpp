#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdint>
#include <ricochet/measure/uncertainty_exponent.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

constexpr double saturated = 0.8;
constexpr std::size_t fewest_sizes = 3;

/// Sums over rectangles of a grid of counts.
class Sums {
 public:
  template <class Count>
  Sums(int columns, int rows, Count count)
      : columns_(columns), sums_(static_cast<std::size_t>(columns + 1) * static_cast<std::size_t>(rows + 1)) {
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) at(i + 1, j + 1) = count(i, j) + at(i, j + 1) + at(i + 1, j) - at(i, j);
  }
  // Over columns [i, i+width) and rows [j, j+height).
  std::int64_t in(int i, int j, int width, int height) const {
    return at(i + width, j + height) - at(i, j + height) - at(i + width, j) + at(i, j);
  }

 private:
  std::int64_t& at(int i, int j) { return sums_[index(i, j)]; }
  std::int64_t at(int i, int j) const { return sums_[index(i, j)]; }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_ + 1) + static_cast<std::size_t>(i);
  }
  int columns_;
  std::vector<std::int64_t> sums_;
};

struct Size {
  double x = 0, y = 0, trust = 0;  // ln ε, ln f, relative error of f by counting
};

}  // namespace

std::optional<Interval> uncertainty_exponent(const std::vector<int>& labels, int columns, int rows) {
  if (columns < 1 || rows < 1 || labels.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("the labels do not fill the grid");
  const auto label = [&](int i, int j) {
    return labels[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)];
  };
  const Sums unknown(columns, rows, [&](int i, int j) { return label(i, j) < 0 ? 1 : 0; });
  const Sums across(columns - 1, rows, [&](int i, int j) { return label(i, j) != label(i + 1, j) ? 1 : 0; });
  const Sums down(columns, rows - 1, [&](int i, int j) { return label(i, j) != label(i, j + 1) ? 1 : 0; });

  const int dimensions = (columns > 1) + (rows > 1);
  const int side = columns == 1 ? rows : rows == 1 ? columns : std::min(columns, rows);
  std::vector<Size> sizes;
  for (int reach = 1; reach <= side / 4; reach *= 2) {
    const int width = columns == 1 ? 0 : reach, height = rows == 1 ? 0 : reach;
    std::int64_t known = 0, mixed = 0;
    for (int j = 0; j + height < rows; ++j)
      for (int i = 0; i + width < columns; ++i) {
        if (unknown.in(i, j, width + 1, height + 1) > 0) continue;
        ++known;
        mixed += across.in(i, j, width, height + 1) + down.in(i, j, width + 1, height) > 0;
      }
    if (mixed == 0) continue;
    const double share = static_cast<double>(mixed) / static_cast<double>(known);
    if (share > saturated) break;
    const double disjoint = static_cast<double>(mixed) / std::pow(reach + 1.0, dimensions);
    sizes.push_back({std::log(reach), std::log(share), 1 / std::sqrt(std::max(1.0, disjoint))});
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
