#pragma once
#include <functional>
#include <optional>
#include <ricochet/measure/orbits/lyapunov.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <string>
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

/// The Lyapunov exponents of one orbit, 1/s, with 95 % block bootstrap intervals.
struct OrbitExponents {
  std::vector<Interval> values;  ///< largest first; those owed to the scheme set apart
  std::optional<Interval> twin;  ///< of the largest, by a twin trajectory
  /// "tangent", "tangent+jump", "twin(1e-07)"; "superstable" where all are −∞; "" where none could be measured.
  std::string method;
  bool blind = false;        ///< none would see its impacts move: tangents_miss_impacts()
  bool saturated = false;    ///< there are no tangents, and the twin is soon as far away as orbits are
  bool superstable = false;  ///< all points come to rest on their stops: LyapunovRates::told is none
  bool outlived = false;     ///< the orbit stays where its exponents would have it leave: outlives()
  bool untold = false;       ///< it has impacts whose jump is not known: LyapunovRates::untold
};

/// The `count` largest exponents of orbits that march in one block, from `states` on, as `plan` has it. `program`
/// makes the block with so many tangent columns per lane; `columns` is one more than `count` where the state has them.
/// Tangents come first. Where `program` throws Refusal for them, the law has no derivative, and a twin gives the
/// largest exponent alone, unless it is soon as far away as orbits are. Beside tangents the twin is a second opinion.
/// Closer than a step's way, an orbit and its twin meet their stops at the same steps, as motions do not: an orbit with
/// jumps has none. Nor has one whose sawtooth is taken out of the columns, which its twin would carry.
std::vector<OrbitExponents> exponents_of(const std::function<Program(int columns)>& program,
                                         const std::vector<LaneState>& states, LyapunovPlan plan, int count,
                                         int columns);

}  // namespace ricochet
