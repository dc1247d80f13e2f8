#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace ricochet {

/// What an orbit of a forced structure does in the long run, but for its period. `failed`: it was not followed to its
/// end. `at_rest`: what touches its stop rests on it, the contact never opens; what else there is may move, as the
/// linear structure held there does.
enum class Regime { no_contact, at_rest, periodic, quasi_periodic, chaotic, undecided, failed };

/// The class of an orbit: its regime and, of a periodic one, after how many forcing periods it repeats. Two orbits of
/// different classes are different motions.
struct MotionClass {
  Regime regime = Regime::undecided;
  int period = 0;  ///< ≥ 1 where the regime is periodic, else 0

  /// Whether it is known what the orbit does.
  bool decided() const { return regime != Regime::undecided && regime != Regime::failed; }
  bool operator==(const MotionClass&) const = default;
};

/// The word of a regime, as in the column `class` of the tables: "no contact", "at rest", "periodic", "quasi-periodic",
/// "chaotic", "undecided", "failed".
const char* text(Regime regime);
/// The same with the period of what has one: "periodic 3".
std::string text(const MotionClass& motion);

/// The class that text() spells in these words; nothing for others. "periodic" alone is none.
std::optional<MotionClass> motion_class(std::string_view words);
/// The class of a row of a table, where regime and period have columns of their own; the period of what is not periodic
/// (a motion whose contacts never change repeats as well) is no part of it.
std::optional<MotionClass> motion_class(std::string_view regime, std::optional<double> period);

/// Points of the cycle that a section of this motion shows where it repeats after `period` forcing periods (0: not
/// known): of a motion whose contacts never change one at least, of what is not periodic none.
int cycle_of(const MotionClass& motion, int period);

}  // namespace ricochet
