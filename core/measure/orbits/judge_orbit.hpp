#pragma once
#include <cstdint>
#include <optional>
#include <ricochet/measure/orbits/regime.hpp>
#include <ricochet/measure/orbits/section_march.hpp>
#include <span>

namespace ricochet {

/// The 0–1 test for chaos: K near 0 for regular motion, near 1 for chaotic. For the series φ_j less its mean and 100
/// frequencies c, seeded, in (π/5, 4π/5),
///
///     p(n) = Σ_{j≤n} φ_j cos jc,   q(n) = Σ_{j≤n} φ_j sin jc
///     D_c(n) = 1/(N−m) Σ_j [p(j+n) − p(j)]² + [q(j+n) − q(j)]²,   n = 1 … m,   m = N/10, 100 at most
///     K_c = correlation of (1, …, m) and (D_c(1), …, D_c(m)),     K = median of K_c
///
/// Without its mean the series has no oscillatory term (Eφ)²(1 − cos nc)/(1 − cos c) to be subtracted, which is what
/// regularises D_c. A constant series gives 0. The series is strobed, hence not oversampled. Nothing below 60 readings
/// or where one is not finite. Source: Gottwald and Melbourne (2009), SIAM J. Appl. Dyn. Syst. 8, 129–145, eqs. (2.1),
/// (3.4), (3.6).
std::optional<double> zero_one_test(std::span<const double> series, std::uint64_t seed = 1);

/// Relative distance at which two readings of an orbit count as the same (see SectionPlan::scale for the unit). An
/// orbit that is still approaching repeats when the limit it approaches does.
constexpr double recurrence_tolerance = 1e-4;
/// What one forcing period puts into an orbit may come back this many times as large: 2/(1 − |μ|) at a multiplier μ of
/// 0.96. Nearer to ±1 what a step makes of an orbit is not told from a change of its class.
constexpr double most_amplified = 50;
/// Of the largest reading: what differs by more is not said to repeat.
constexpr double most_left_open = 0.05;
/// Impacts on one side within one forcing period from which a motion is said to chatter.
constexpr int chatter_impacts = 10;

/// Whether a stop was touched while the orbit was kept.
bool touches(const Orbit& orbit);
/// Whether what touches its stop rests on it: the contact lasted over all kept periods, and no point came to a stop.
bool rests(const Orbit& orbit);
/// Mean over the kept periods, both sides.
double impacts_per_period(const Orbit& orbit);

/// What the readings of an orbit say about its period, and what the step leaves open of that. Impacts that rebound are
/// placed to within a step: an orbit of period p then repeats within
///     D = min(50 u, 0.05 largest reading),    u = h Σ|v₊ − v₋| / scale, over one period,                          (2)
/// and wanders, or locks to some multiple of p, below it.
struct OrbitPeriod {
  Recurrence recurrence;                    ///< within `tolerance`
  double tolerance = recurrence_tolerance;  ///< that, or half of (2) where it is larger
  double placed = 0;                        ///< u
  double open = 0;                          ///< D
  /// The smallest lag at which the readings differ by less than twice (2), short of the period or without one. They may
  /// repeat at it, and the step does not tell. 0: none.
  int doubtful = 0;
  double doubtful_distance = 0;
};
OrbitPeriod orbit_period(const Orbit& orbit, const SectionPlan& plan);

/// Whether an orbit stays what it is where neighbours would part at this rate. It repeats within what its step leaves
/// open, wanders by more than recurrence_tolerance, and does not drift away. Its largest
/// distance times e^{low T window} is more than SectionPlan::scale. The tangents along it then are no derivative of
/// what the step makes of a neighbour.
bool outlives(const OrbitPeriod& period, const Interval& exponent, const SectionPlan& plan);

/// What the kept periods of an orbit say. Two orbits of one motion, begun apart, end as far apart as the step places
/// their impacts and the motion forgets that:
///     open = min(D, u min(50, 1/(1 − r))),                                                                      (3)
/// r = e^{high T} of an exponent whose interval lies below zero, else the contraction of the recurrence.
struct JudgedOrbit {
  Recurrence recurrence;
  std::optional<double> zero_one;  ///< K of the strobed displacements
  /// Whether the last round of what repeats is its own image under x → −x, t → t + T/2 (within ten times the
  /// tolerance).
  std::optional<bool> symmetric;
  RegimeVerdict verdict;
};

/// Reads a complete orbit; its largest exponent where it is known. Nothing is told of an orbit that is not complete.
JudgedOrbit judge(const Orbit& orbit, const SectionPlan& plan, const std::optional<Interval>& exponent);

/// Points of an orbit's end that are kept where nothing repeats, at most.
constexpr int longest_end = 64;
/// Judges a complete orbit without an exponent, and leaves what its end is drawn from. These are the strobed points of
/// one period of what repeats, else the last 64. In `readings` their displacements alone are left (width 1). Of an
/// orbit that stopped the cause and the counts are left. No states: it cannot go on.
void keep_end(Orbit& orbit, const SectionPlan& plan);

/// The class of a complete orbit as far as its readings tell without K and exponents: what does not repeat is one
/// class, undecided. Nothing for an orbit that is not complete.
std::optional<MotionClass> rough_class(const Orbit& orbit, const SectionPlan& plan);

}  // namespace ricochet
