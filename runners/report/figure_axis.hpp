#pragma once
#include <string>
#include <utility>
#include <vector>

namespace ricochet::report {

/// A scale from values to places of a drawing: linear, or of logarithms. Its ends are round numbers, and all values
/// that it is made of lie between them.
class FigureAxis {
 public:
  /// `values`: finite; for logarithms positive. `from`, `to`: places of its ends; at most `most` ticks.
  FigureAxis(const std::vector<double>& values, bool logarithms, double from, double to, int most);

  double at(double value) const;
  double low() const { return low_; }
  double high() const { return high_; }
  bool logarithms() const { return logarithms_; }
  /// Values in ascending order, each with its text.
  const std::vector<std::pair<double, std::string>>& ticks() const { return ticks_; }

 private:
  void round_linear(int most);
  void round_logarithms(int most);
  double low_ = 0, high_ = 1;
  bool logarithms_;
  double from_, to_;
  std::vector<std::pair<double, std::string>> ticks_;
};

/// Whether values are all positive and span so large a factor.
bool spans(const std::vector<double>& values, double factor);

}  // namespace ricochet::report
