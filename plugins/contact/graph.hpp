#pragma once
#include <algorithm>
#include <limits>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <ricochet/contract/parameters.hpp>
#include <vector>

namespace ricochet {

/// A graph of straight lines from [0, 0] on: 0 below, beyond the last row with a slope of its own. Empty: 0 everywhere.
class Graph {
 public:
  Graph() = default;
  /// Beyond the last row with the slope of the last line.
  explicit Graph(const ParameterTable& rows) {
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
      const double width = rows[i + 1][0] - rows[i][0];
      add(rows[i], (rows[i + 1][1] - rows[i][1]) / width);
    }
  }
  Graph(const ParameterTable& rows, double beyond) : Graph(rows) { add(rows.back(), beyond); }

  bool empty() const { return lines_.empty(); }
  bool straight() const { return lines_.size() == 1; }
  double last_slope() const { return lines_.empty() ? 0.0 : lines_.back().slope; }
  double steepest() const {
    double slope = 0;
    for (const Line& one : lines_) slope = std::max(slope, one.slope);
    return slope;
  }

  double value(double x) const { return x > 0 && !empty() ? line(x).value(x) : 0.0; }
  double slope(double x) const { return x >= 0 && !empty() ? line(x).slope : 0.0; }
  /// ∫₀ˣ y dx.
  double integral(double x) const {
    if (!(x > 0) || empty()) return 0;
    const Line& at = line(x);
    return at.area + 0.5 * (at.y + at.value(x)) * (x - at.x);
  }

  /// The mean of y between x⁻ and x, and its slopes by both: sums over the lines between them, where nothing cancels.
  PointForce mean(double x, double before) const {
    if (x == before) return {.value = value(x), .stiffness = 0.5 * slope(x), .before = 0.5 * slope(x)};
    PointForce sum;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Line& one = lines_[i];
      const double end = i + 1 < lines_.size() ? lines_[i + 1].x : std::numeric_limits<double>::infinity();
      const double from = std::clamp(before, one.x, end), to = std::clamp(x, one.x, end);
      if (from == to) continue;
      const double way = x - before, begins = (from - before) / way, ends = (to - before) / way;
      const double share = (to - from) / way, middle = 0.5 * (begins + ends);
      sum.value += share * one.value(0.5 * (from + to));
      sum.stiffness += one.slope * share * middle;
      sum.before += one.slope * share * (1 - middle);
    }
    return sum;
  }

  /// The first x ≥ 0 where y is no more than `slope` x + `offset`, which no line is steeper than; ∞ where there is
  /// none.
  double meets(double slope, double offset) const {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Line& one = lines_[i];
      const double above = one.y - slope * one.x - offset;
      if (!(above > 0)) return one.x;
      if (!(slope > one.slope)) continue;
      const double x = one.x + above / (slope - one.slope);
      if (i + 1 == lines_.size() || x < lines_[i + 1].x) return x;
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  struct Line {
    double x, y, slope, area;  // where it begins, and the integral up to there
    double value(double at) const { return y + slope * (at - x); }
  };
  void add(const std::array<double, 2>& row, double slope) {
    const double area =
        lines_.empty() ? 0.0 : lines_.back().area + 0.5 * (lines_.back().y + row[1]) * (row[0] - lines_.back().x);
    lines_.push_back({row[0], row[1], slope, area});
  }
  // The last that begins at x or before; x ≥ 0.
  const Line& line(double x) const {
    const auto after =
        std::upper_bound(lines_.begin(), lines_.end(), x, [](double at, const Line& one) { return at < one.x; });
    return *(after == lines_.begin() ? after : after - 1);
  }

  std::vector<Line> lines_;
};

}  // namespace ricochet
