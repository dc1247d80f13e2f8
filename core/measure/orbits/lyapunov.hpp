#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// How exponents are measured.
struct LyapunovPlan {
  int steps_per_period = 0;
  int strobe = 0;        ///< the lanes begin one step after this step of the period
  int periods = 300;     ///< measured
  int discard = 10;      ///< before them, while the columns find their directions
  double pulsation = 0;  ///< ω of the forcing, rad/s
  /// Takes the root −1 out of the columns once per period, X ← (X_n + X_{n−1})/2. It serves schemes whose stability
  /// analysis finds that root on the kernel of the mass. There it would hide what is physical.
  bool without_sawtooth = false;
  std::uint64_t seed = 1;
  bool keep_orbit = false;  ///< whether LyapunovRates::orbit is wanted
  std::vector<int> rounds;  ///< per lane, the periods after which its orbit repeats; 0, or no entry: not known
  int round(std::size_t lane) const { return lane < rounds.size() ? rounds[lane] : 0; }
};

/// Growth of the tangent columns of one lane.
struct LyapunovRates {
  std::vector<std::vector<double>> rates;  ///< per column, per measured period of whole rounds: ln R_kk / T, 1/s
  LaneEnd end;                             ///< of a lane that stopped; none otherwise
  int jumps = 0;                           ///< impacts with inertia whose jump was applied
  int told = 0;    ///< columns, from the first on, that have a growth; none: the orbit is superstable (see below)
  int untold = 0;  ///< impacts in the measured periods whose jump is not known: rates are none
  /// Per column and the one after it, the share of whole rounds whose map in the plane of both has no real eigenvalue.
  /// Empty where no round was measured.
  std::vector<double> turning;
  int saturated = 0;             ///< measured periods after which a twin was a hundredth of the orbit away
  std::vector<LaneState> orbit;  ///< of the lane itself after each period, discarded ones first
};

/// Lyapunov exponents along the lanes of a program that has tangent columns. The block marches period after period from
/// `states`, one step after a strobe. After each period the columns are orthonormalised, X = Q R, and ln R_kk/T is
/// recorded. Their norm is in metres: velocities count over ω, accelerations over ω². The k-th exponent is the mean
/// over periods.
///
/// With n coordinates the state has 2n directions. A massive point that comes to rest on its stop ends two of them, an
/// impact without rebound one (ImpactJump). The exponents of as many last columns are −∞, and of all columns where n
/// points rest at once.
///
/// Over a round of p periods, X_p = A X_0 and X_p = Q R with R the product of the periods' own: the blocks of QᵀA Q
/// between neighbouring columns are those of Q_0ᵀ Q_p R, upper triangular but for pairs (real Schur form).
/// Source: Benettin, Galgani, Giorgilli and Strelcyn (1980), Meccanica 15, 9–30; QR after Geist, Parlitz and Lauterborn
/// (1990).
std::vector<LyapunovRates> lyapunov_rates(Program program, const std::vector<LaneState>& states,
                                          const LyapunovPlan& plan);

/// The same growth measured with a twin: a second trajectory `offset` metres away (in the norm above), brought back to
/// that distance once per period. The lanes of the program are the twins, and `states` are those of the orbits. Orbit i
/// went from there as `orbits[i].orbit` says (lyapunov_rates() with keep_orbit; without tangent columns it does nothing
/// else). Of a twin that is as far away as orbits are, a rate is a lower bound: `saturated`
/// counts those.
std::vector<LyapunovRates> twin_rates(Program program, const std::vector<LaneState>& states,
                                      const std::vector<LyapunovRates>& orbits, const LyapunovPlan& plan,
                                      double offset);

/// The mean growth of one tangent column (its rates per period, 1/s) with its 95 % block bootstrap interval. Of fewer
/// periods than can be resampled it is the mean alone.
Interval exponent_interval(const std::vector<double>& rates);

/// The `count` largest exponents of tangent columns (rates per column and period, columns from the largest on). Two
/// multipliers that are a complex pair turn their plane. Each column's growth then swings from period to period, that
/// of the area does not, and both exponents are half of it. So one column more than exponents are wanted must be there,
/// or the last may be half of a pair unseen. Columns are a pair where three things hold. Their means agree up to their
/// swing, the variance of the area's growth is below a twentieth of the first column's, and their plane turns.
/// `turning`, per column with the next, is the share of the orbit's rounds whose map turns it (LyapunovRates::turning);
/// a pair needs more than half. Two real multipliers of an orbit that repeats after p periods swing as well, once per
/// round. Where no round is known (empty), the difference of the two columns' growth, summed, must stay within twice
/// its own swing.
std::vector<Interval> exponent_intervals(const std::vector<std::vector<double>>& rates, int count,
                                         const std::vector<double>& turning = {});

/// The Lyapunov exponents of one orbit, 1/s, with 95 % block bootstrap intervals.
struct OrbitExponents {
  std::vector<Interval> values;  ///< largest first; those owed to the scheme set apart
  std::optional<Interval> twin;  ///< of the largest, by a twin trajectory
  /// "tangent", "tangent+jump", "twin(1e-07)"; "superstable" where all are −∞; "" where none could be measured.
  std::string method;
  bool blind = false;        ///< none would see its impacts move: tangents_miss_impacts(), twins_miss_impacts()
  bool saturated = false;    ///< there are no tangents, and the twin is soon as far away as orbits are
  bool superstable = false;  ///< all points come to rest on their stops: LyapunovRates::told is none
  bool outlived = false;     ///< the orbit stays where its exponents would have it leave: outlives()
  bool untold = false;       ///< it has impacts whose jump is not known: LyapunovRates::untold
};

/// The `count` largest exponents of orbits that march in one block, from `states` on, as `plan` has it. `program`
/// makes the block with so many tangent columns per lane; `columns` is one more than `count` where the state has them.
/// Tangents come first. Where `program` throws Refusal for them, the law has no derivative. A twin then gives the
/// largest exponent alone, unless it is soon as far away as orbits are. Beside tangents the twin is a second opinion.
/// An orbit with jumps has no twin: closer than a step's way, both meet their stops at the same steps, as motions do
/// not. An orbit has none either where a sawtooth is taken out of the columns, as its twin would carry it.
std::vector<OrbitExponents> exponents_of(const std::function<Program(int columns)>& program,
                                         const std::vector<LaneState>& states, LyapunovPlan plan, int count,
                                         int columns);

}  // namespace ricochet
