#pragma once
#include <array>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <ricochet/measure/orbits/recurrence.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <string>
#include <string_view>

namespace ricochet {

/// What an orbit of a forced structure does in the long run, but for its period. `failed`: it was not followed to its
/// end. `at_rest`: what touches its stop rests on it, the contact never opens; what else there is may move, as the
/// linear structure held there does. `chattering`: it repeats, and within a period a point that is thrown back with a
/// share of its speed comes to rest on its stop: it has hit it without number.
enum class Regime { no_contact, at_rest, periodic, chattering, quasi_periodic, chaotic, undecided, failed };

/// The class of an orbit: its regime and, of a periodic one, after how many forcing periods it repeats. Two orbits of
/// different classes are different motions.
struct MotionClass {
  Regime regime = Regime::undecided;
  int period = 0;  ///< ≥ 1 where the regime is periodic or chattering, else 0

  /// Whether the class says a period.
  bool repeats() const { return regime == Regime::periodic || regime == Regime::chattering; }

  /// Whether it is known what the orbit does.
  bool decided() const { return regime != Regime::undecided && regime != Regime::failed; }
  bool operator==(const MotionClass&) const = default;
};

/// As in the column `class` of the tables.
constexpr std::array<const char*, 8> words_of(Regime) {
  return {"no contact", "at rest", "periodic", "chattering", "quasi-periodic", "chaotic", "undecided", "failed"};
}
/// The word of the regime, with the period of what has one: "periodic 3".
std::string text(const MotionClass& motion);

/// The class that text() spells in these words; nothing for others. "periodic" alone is none.
std::optional<MotionClass> motion_class(std::string_view words);
/// The class of a row of a table, where regime and period have columns of their own. The period of what is not periodic
/// is no part of it. A motion whose contacts never change repeats as well.
std::optional<MotionClass> motion_class(std::string_view regime, std::optional<double> period);

/// Points of the cycle that a section of this motion shows: of a periodic one as many as its own period. Of a motion
/// whose contacts never change they are `period` (forcing periods; 0: not known), one at least. Others have none.
int cycle_of(const MotionClass& motion, int period);

/// Readings that the 0–1 test needs.
inline constexpr int zero_one_readings = 60;

/// What is known of one orbit over its kept periods.
struct RegimeInput {
  bool contact = false;   ///< whether any stop was touched
  bool rests = false;     ///< whether the contact never opened
  bool sticks = false;    ///< whether a point that rebounds came to rest on its stop
  Recurrence recurrence;  ///< of its section
  std::optional<Interval>
      exponent;  ///< largest Lyapunov exponent, 1/s; −∞: superstable; those owed to the scheme are set apart
  std::optional<double> zero_one;  ///< K
  double shrunk = 1;               ///< shrunk_ranges() of its section; below 1: they shrink
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
  double open = 0;       ///< how far the step leaves its section open, relative (judge_orbit.hpp); 0: by nothing known
};

/// 1. No contact: no stop was touched. At rest: one was, and that contact never opened.
/// 2. Undecided: the step does not tell whether the section repeats at a shorter lag than the one found, or at all.
/// 3. Periodic: the section repeats; chattering where a point that rebounds came to rest. An exponent above zero
///    contradicts that: undecided. It is above zero where its interval is, and the growth it means over the window,
///    e^{low T window}, is 2 or more (where T is known).
/// 4. Chaotic: the exponent is above zero. Neighbours of a regular orbit part in proportion to time, N-fold over a
///    window of N periods. So where K < 0.2, or the ranges of the section shrink, the growth must exceed N: else
///    undecided. Without an exponent, K > 0.8 and ranges that do not shrink.
/// 5. Quasi-periodic: K < 0.2, the exponent's interval, if any, holds zero or growth below 2, and the section does not
///    approach an orbit. It does where distances halved over the window, or its ranges shrink.
/// 6. Undecided otherwise; the sentence says what is missing or what contradicts.
/// `failed` is for those who march: nothing is classified as failed here.
RegimeVerdict classify(const RegimeInput& input);

}  // namespace ricochet
