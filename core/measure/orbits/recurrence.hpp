#pragma once
#include <array>
#include <cstddef>
#include <vector>

/// \file
/// Whether an orbit repeats on its section. The distance at lag p is relative, column by column:
///
///     d_k(p) = max_c |x_{k,c} − x_{k−p,c}| / scale_c                                                           (1)
///
/// A column whose scale is 0 repeats only where it is equal.
namespace ricochet {

/// Readings x_k ∈ R^width of one orbit on its section, one row per forcing period, oldest first. Each column has its
/// own unit (tip displacement in m, tip velocity in m/s, …).
struct SectionSeries {
  int width = 0;
  std::vector<double> values;  ///< row after row
  int periods() const { return width > 0 ? static_cast<int>(values.size()) / width : 0; }
  const double* row(int k) const { return values.data() + static_cast<std::ptrdiff_t>(k) * width; }
};

/// Longest period that is looked for, in forcing periods.
constexpr int longest_period = 64;

struct Recurrence {
  int period = 0;          ///< p, in forcing periods; 0: none up to the longest
  double distance = 0;     ///< max d_k(p) over the window; without a period, of the lag where that is smallest
  double contraction = 1;  ///< of d_k(p) per forcing period; 1 at round-off and where nothing tells it from 1
  int window = 0;          ///< rows looked at, the last ones; 0: too few for any lag
};

/// The smallest p ≤ longest at which the orbit repeats over a window of its last rows. The window is all rows, or else
/// the last half, and at least 2p + 8 rows. One of these holds:
///   - max d_k(p) ≤ tolerance, and the distances do not grow to leave it within another such window. An unstable orbit
///     that is being left does not count.
///   - The largest d_k(p) of each p periods follow L + A ρ^k with ρ < 1, A > 0 and a scatter below a tenth. |L| plus
///     three standard errors is at most the tolerance. This is an orbit that has not quite arrived.
/// Besides, no divisor q of p may repeat one day. It may where its distances d_k(q) fall by a tenth or more over the
/// window and have not come within a tenth of their limit. Near a period doubling d_k(2p) is small long before d_k(p)
/// is, and the orbit may be either.
///
/// `contraction` is e^slope of ln d_k over k, where the slope is three standard errors from 0. Distances below 1e-13
/// are round-off and end the fit. Rows that are not finite repeat nothing; no distance is told as larger than 1e9.
/// Throws std::invalid_argument when `scale` does not give one finite number ≥ 0 per column.
Recurrence find_recurrence(const SectionSeries& series, const std::vector<double>& scale, double tolerance,
                           int longest = longest_period);

/// The largest d_k(lag) of (1) over all rows of the series; infinite where there are none so far apart.
double lag_distance(const SectionSeries& series, const std::vector<double>& scale, int lag);

/// The largest range of a column in the last third of the rows over that in the first, where the range of every column
/// shrinks from third to third. 1 otherwise, and below 24 rows. An orbit on a torus fills the same ranges again; one
/// that still approaches another shrinks them, however slowly its distances do.
double shrunk_ranges(const SectionSeries& series);

/// The same question asked once per period of an integration that waits for its transient to end. Plain data, O(longest
/// · width) per period, no allocation after construction.
struct Settling {
  std::vector<double> scale;  ///< one per column, as for find_recurrence()
  double tolerance = 0;
  int longest = longest_period;
  std::vector<double> ring;  ///< the last `longest` rows
  std::vector<int> repeats;  ///< per lag: successive periods within tolerance so far
  long long periods = 0;     ///< rows seen

  Settling() = default;
  Settling(std::vector<double> scale_per_column, double relative_tolerance, int longest_lag = longest_period);

  /// Takes the row of one period; true when settled.
  bool add(const double* row);
  /// Whether some lag p has repeated within the tolerance (1) for max(p, 4) + 4 successive periods.
  bool settled() const { return period() > 0; }
  /// The smallest such p; 0: none yet.
  int period() const;
  /// Forgets the rows, keeps scale and tolerance.
  void clear();
};

/// Whether two clouds of section points are the same: each point of either has one of the other within
/// max_c |a_c − b_c|/scale_c ≤ tolerance. This is the Hausdorff distance in that norm. With b the image of a under x →
/// −x, t → t + T/2 (the opposite section, negated), this is the symmetry of the orbit. Two empty clouds are the same.
bool same_cloud(const std::vector<std::array<double, 2>>& a, const std::vector<std::array<double, 2>>& b,
                const std::array<double, 2>& scale, double tolerance);

}  // namespace ricochet
