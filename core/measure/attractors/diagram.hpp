#pragma once
#include <cstddef>
#include <optional>
#include <ricochet/measure/orbits/regime.hpp>
#include <string>
#include <vector>

/// \file
/// A bifurcation diagram of several cases, cases × values of the parameter × starts, in the shape that comparisons
/// need.
namespace ricochet {

/// What one value of the parameter and one start came to.
struct DiagramRun {
  double parameter = 0;
  int value = 0, start = 0;  ///< indices into Diagram::values and Diagram::starts
  bool settled = false;      ///< marched to its end: there is a section
  std::string status = {};   ///< where it was not: what the case says instead, "diverged"
  MotionClass motion = {};   ///< failed where it was not settled
  int period = 0;            ///< of what repeats, be it without contact; 0: nothing does
  std::optional<bool> symmetric = {};
  std::optional<double> viscosity = {};  ///< numerical, as a multiple of the stiffness: α_eq, s
  int attractor = 0;                     ///< from 1; 0: none
  /// Whether it shows an attractor.
  bool decided() const { return motion.decided(); }
  /// Points of the strobed section that repeat; 0: it is no cycle.
  int cycle() const;
};

/// One case.
struct DiagramCase {
  std::vector<DiagramRun> runs = {};     ///< as its table has them
  std::vector<int> at = {};              ///< value × starts + start → index into runs, −1 where there is none
  std::optional<double> compliance = 0;  ///< of the contact law, m/N; 0: rigid; none: not known
  double steps_per_period = 0, elements = 0;
  double modes = 0;  ///< of the basis that it marches in; ∞: all dofs of the mesh
  bool any_decided() const;
};

/// How orbits begin.
struct DiagramStart {
  std::string name;
  bool random = false;  ///< a random state, as others are
};

/// The whole study.
struct Diagram {
  std::vector<double> values;  ///< of all cases, ascending
  std::vector<DiagramStart> starts;
  std::vector<DiagramCase> cases;
  int attractors = 0;  ///< identities run from 1 to this

  const DiagramRun* run(std::size_t case_index, int value, int start) const;
  DiagramRun* run(std::size_t case_index, int value, int start);
  int start_count() const { return static_cast<int>(starts.size()); }
  int value_count() const { return static_cast<int>(values.size()); }
  /// Fills in `values`, the runs' `value` and the cases' `at` from the runs' parameters and starts.
  void number_values();
};

/// The case that others are compared with, of those with anything decided. It has the stiffest contact (a rigid one,
/// where there is one), then the most steps per period, the most elements, all dofs or the most modes; else it is the
/// first.
std::optional<std::size_t> reference_case(const Diagram& diagram);

/// Values × starts where both cases decided, and how many of them agree.
struct Agreement {
  int compared = 0, same_class = 0, same_attractor = 0;
};
Agreement agreement(const DiagramCase& one, const DiagramCase& other);

}  // namespace ricochet
