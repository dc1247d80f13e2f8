#pragma once
#include <optional>
#include <ricochet/measure/orbits/regime.hpp>
#include <ricochet/measure/orbits/section_march.hpp>

namespace ricochet {

/// Relative distance at which two readings of an orbit count as the same (see SectionPlan::scale for the unit). An
/// orbit that is still approaching repeats when the limit it approaches does.
constexpr double recurrence_tolerance = 1e-4;
/// Impacts on one side within one forcing period from which a motion is said to chatter.
constexpr int chatter_impacts = 10;

/// Whether a stop was touched while the orbit was kept.
bool touches(const Orbit& orbit);
/// Mean over the kept periods, both sides.
double impacts_per_period(const Orbit& orbit);

/// What the kept periods of an orbit say.
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

/// The class of a complete orbit as far as its readings tell without K and exponents: what does not repeat is one
/// class, undecided. Nothing for an orbit that is not complete.
std::optional<MotionClass> rough_class(const Orbit& orbit, const SectionPlan& plan);

}  // namespace ricochet
