#pragma once
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <vector>

namespace ricochet {

/// The mean growth of one tangent column (its rates per period, 1/s) with its 95 % block bootstrap interval; of fewer
/// periods than can be resampled the mean alone.
Interval exponent_interval(const std::vector<double>& rates);

/// The `count` largest exponents of tangent columns (rates per column and period, columns from the largest on). Two
/// multipliers that are a complex pair turn their plane: each column's growth swings from period to period while that
/// of the area does not, and both exponents are half of it. So one column more than exponents are wanted must be there,
/// or the last may be half of a pair unseen. Columns are a pair where their means agree up to their swing, the variance
/// of the area's growth is below a twentieth of that of the first, and their plane turns. `turning`, per column with
/// the next, is the share of the orbit's rounds whose map turns it (LyapunovRates::turning): more than half. Two real
/// multipliers of an orbit that repeats after p periods swing as well, once per round. Where no round is known (empty),
/// the difference of the two columns' growth, summed, must stay within twice its own swing.
std::vector<Interval> exponent_intervals(const std::vector<std::vector<double>>& rates, int count,
                                         const std::vector<double>& turning = {});

}  // namespace ricochet
