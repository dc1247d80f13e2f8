#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <string>
#include <vector>

namespace ricochet::benchmarks {

/// The median of repeated measurements, and their range, in a unit: "1.23 (1.2 to 1.31)".
inline std::string shown_range(std::vector<double> values, double unit) {
  for (double& value : values) value *= unit;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", median(values), *least, *most);
}

}  // namespace ricochet::benchmarks
