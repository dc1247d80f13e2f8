#pragma once
#include <cstddef>
#include <vector>

namespace ricochet {

/// Readings of one orbit on its section, one row per forcing period (oldest first): x_k ∈ R^width, each column in its
/// own unit (tip displacement in m, tip velocity in m/s, …).
struct SectionSeries {
  int width = 0;
  std::vector<double> values;  ///< row after row
  int periods() const { return width > 0 ? static_cast<int>(values.size()) / width : 0; }
  const double* row(int k) const { return values.data() + static_cast<std::ptrdiff_t>(k) * width; }
};

}  // namespace ricochet
