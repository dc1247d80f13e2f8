#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <functional>

/// \file
/// A function of x ∈ [0, L] on equal panels: eight Gauss points each, and the Legendre polynomial of degree 7 through
/// them, which knows the second derivative that a bending energy needs.
namespace ricochet::event_driven {

class PanelSeries {
 public:
  static constexpr int points = 8;

  PanelSeries(const std::function<double(double)>& f, double length, int panels)
      : width_(length / panels), panels_(panels), series_(points, panels) {
    for (int i = 0; i < panels; ++i) {
      series_.col(i).setZero();
      for (int g = 0; g < points; ++g) {
        const double value = f((i + 0.5 * (1 + abscissa(g))) * width_);
        largest_ = std::max(largest_, std::abs(value));
        finite_ = finite_ && std::isfinite(value);
        series_.col(i) += 0.5 * weight(g) * value * (legendre(abscissa(g)).col(0) * odd_numbers()).matrix();
      }
    }
  }

  bool finite() const { return finite_; }
  double largest() const { return largest_; }  ///< max |f| at the Gauss points
  double value(double x) const { return derivative(x, 0); }
  double slope(double x) const { return derivative(x, 1) * 2 / width_; }
  double curvature(double x) const { return derivative(x, 2) * 4 / (width_ * width_); }

  /// ∫₀ᴸ g(x) dx by the Gauss points of `panels` equal panels; g a number or an array like `zero`.
  template <class Function, class Value = double>
  static Value integral(const Function& g, double length, int panels, const Value& zero = Value{}) {
    Value sum = zero;
    for (int i = 0; i < panels; ++i)
      for (int j = 0; j < points; ++j) sum += weight(j) * g((i + 0.5 * (1 + abscissa(j))) * length / panels);
    return sum * (length / (2 * panels));
  }

 private:
  using Column = Eigen::Array<double, points, 1>;

  static double signed_of(const std::array<double, 4>& half, int g, double sign) {
    return g < 4 ? sign * half[static_cast<std::size_t>(3 - g)] : half[static_cast<std::size_t>(g - 4)];
  }
  static double abscissa(int g) {
    return signed_of({0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363}, g, -1);
  }
  static double weight(int g) {
    return signed_of({0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763}, g, 1);
  }
  static Column odd_numbers() { return Column::LinSpaced(1, 2 * points - 1); }

  // P_j, P_j', P_j'' (columns) for j < points (rows).
  static Eigen::Array<double, points, 3> legendre(double x) {
    Eigen::Array<double, points, 3> p = Eigen::Array<double, points, 3>::Zero();
    p(0, 0) = 1;
    p(1, 0) = x;
    p(1, 1) = 1;
    for (int j = 1; j + 1 < points; ++j) {
      p(j + 1, 0) = ((2 * j + 1) * x * p(j, 0) - j * p(j - 1, 0)) / (j + 1);
      p(j + 1, 1) = p(j - 1, 1) + (2 * j + 1) * p(j, 0);
      p(j + 1, 2) = p(j - 1, 2) + (2 * j + 1) * p(j, 1);
    }
    return p;
  }

  double derivative(double x, int order) const {
    const int i = std::clamp(static_cast<int>(x / width_), 0, panels_ - 1);
    return (series_.col(i).array() * legendre(2 * (x / width_ - i) - 1).col(order)).sum();
  }

  double width_;
  int panels_;
  Eigen::Matrix<double, points, Eigen::Dynamic> series_;
  double largest_ = 0;
  bool finite_ = true;
};

}  // namespace ricochet::event_driven
