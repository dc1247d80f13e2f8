#pragma once
#include <optional>
#include <ricochet/measure/orbits/motion_class.hpp>
#include <ricochet/measure/orbits/recurrence.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <string>

namespace ricochet {

/// What is known of one orbit over its kept periods.
struct RegimeInput {
  bool contact = false;   ///< whether any stop was touched
  bool rests = false;     ///< whether the contact never opened
  Recurrence recurrence;  ///< of its section
  std::optional<Interval>
      exponent;  ///< largest Lyapunov exponent, 1/s; −∞: superstable; those owed to the scheme are set apart
  std::optional<double> zero_one;  ///< K
  double impacts_per_period = 0;
  bool settled = true;        ///< false: the transient was cut at its cap
  double tolerance = 0;       ///< of the recurrence, relative
  double forcing_period = 0;  ///< T, s; 0: not known
  double placed = 0;          ///< what a step leaves open of the section per period, relative; 0: nothing is known
  int doubtful = 0;           ///< a lag at which the section may repeat as far as the step tells; 0: none
  double doubtful_distance = 0;
};

struct RegimeVerdict {
  MotionClass motion;
  int period = 0;        ///< forcing periods, of what repeats, be it without contact; 0: nothing does
  std::string evidence;  ///< one sentence, with the numbers
};

/// 1. No contact: no stop was touched. At rest: one was, and that contact never opened.
/// 2. Undecided: the step does not tell whether the section repeats at a shorter lag than the one found, or at all.
/// 3. Periodic: the section repeats. An exponent whose interval lies above zero contradicts that, unless T is known and
///    the growth it means over the window, e^{low T window}, is less than 2: undecided.
/// 4. Chaotic: the exponent's interval lies above zero; without an exponent, K > 0.8.
/// 5. Quasi-periodic: the exponent's interval holds zero and K < 0.2; without an exponent, K < 0.2 and the section does
///    not approach an orbit (distances that halved over the window do).
/// 6. Undecided otherwise; the sentence says what is missing or what contradicts.
/// `failed` is for those who march: nothing is classified as failed here.
RegimeVerdict classify(const RegimeInput& input);

}  // namespace ricochet
