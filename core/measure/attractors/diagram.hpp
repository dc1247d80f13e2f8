#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/orbits/regime.hpp>
#include <ricochet/measure/statistics/choices.hpp>
#include <set>
#include <string>
#include <utility>
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
  double open = 0;           ///< how far the step leaves its section open, m
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
/// where there is one). Ties are decided by the most steps per period, the most elements, and all dofs or the most
/// modes, in this order. Of cases equal in all it is the first.
std::optional<std::size_t> reference_case(const Diagram& diagram);

/// Values × starts where both cases decided, and how many of them agree.
struct Agreement {
  int compared = 0, same_class = 0, same_attractor = 0;
};
Agreement agreement(const DiagramCase& one, const DiagramCase& other);

/// One attractor over the cases that could tell.
struct Presence {
  std::vector<std::size_t> cases;  ///< indices of the cases that decided something where it exists
  std::vector<int> present;        ///< of each, 1 or 0: whether it shows there half as often as in any case, or more
};

/// Share of the differences from which a choice is named.
constexpr double kNamedShare = 0.5;

/// What an attractor hangs on.
enum class PresenceKind {
  not_compared,     ///< fewer than two cases could tell
  common,           ///< every case shows it
  vanishes,         ///< none of the finest cases does, other choices being equal, and a coarser one does
  one_choice,       ///< a choice tells half of its presence or more
  several_choices,  ///< none does
};
struct PresenceVerdict {
  PresenceKind kind = PresenceKind::not_compared;
  std::size_t shown = 0;       ///< cases that show it
  DecidingChoice choice = {};  ///< the best, unless all agree
};

/// `axes` hold a level for each case of the study. Refinement is what the axes `steps_per_period` and `elements` say.
PresenceVerdict judge_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes);

// Whether the cases of a diagram agree on the attractors, value by value, and which choice tells them apart.

enum class Robustness {
  robust,     ///< every case that counts shows the same attractors
  depends,    ///< they differ
  undecided,  ///< those that decide agree, others are open
};

/// What the cases say at one value.
struct Opinion {
  int value = 0;
  Robustness verdict = Robustness::undecided;
  DecidingChoice choice = {};                          ///< where they differ
  std::map<std::size_t, std::set<int>> decided = {};   ///< case → attractors
  std::map<std::size_t, const DiagramRun*> open = {};  ///< case → the last of its runs that is not decided
  bool same_classes = true;                            ///< the attractors differ, their classes do not
  /// Whether one choice tells half of the differences or more.
  bool one_choice() const;
};

/// Neighbouring values of one verdict and one choice.
using Stretch = std::vector<Opinion>;

/// The stretches along the parameter. A value counts where two cases or more speak of it, and at least half as many as
/// of any other value. A change that one case refined is no place to compare. A case that decides nothing anywhere says
/// nothing of any value. `axes` hold a level for each case.
std::vector<Stretch> stretches_of(const Diagram& diagram, const std::vector<ChoiceAxis>& axes);

/// The class of each attractor, by its number.
std::map<int, MotionClass> attractor_classes(const Diagram& diagram);

/// Sets of attractors that the given cases show over a stretch, most frequent first.
std::vector<std::set<int>> attractor_sets(const Stretch& stretch, const std::set<std::size_t>& cases);

/// A numerical viscosity counts as small up to this share of the physical one.
inline constexpr double small_viscosity = 0.01;

/// The cases of a stretch whose numerical viscosity is not small against α, and which choice they share. The limit
/// is a hundredth of α, or 1e-12 s where the structure has none: round-off leaves that much of none.
struct ThickCases {
  std::set<std::size_t> told, thick;  ///< cases whose viscosity is known; those where it is not small
  double largest = 0;                 ///< s
  double physical = 0;                ///< α beside the largest, s
  DecidingChoice choice = {};
};
/// `viscosity` is α of a run, s; nothing where the structure has no such number.
ThickCases thick_cases(
    const Diagram& diagram, const Stretch& stretch, const std::vector<ChoiceAxis>& axes,
    const std::function<std::optional<double>(std::size_t case_index, const DiagramRun&)>& viscosity);

// Attractors of a bifurcation diagram: clusters over the starts of a case, followed along the parameter, matched over
// cases as whole branches (attractors.hpp).

/// The section of a settled run, ready to be compared.
using RunSection = std::function<SettledSection(std::size_t case_index, const DiagramRun& run)>;
/// The sections at one value, by case and start; of settled runs alone.
using ValueSections = std::map<std::pair<std::size_t, int>, SettledSection>;

/// Fills in the attractor of every decided run; identities are numbered along the parameter. A motion without contact
/// is the linear response: of one scene there is one, told by its class. Each section is prepared once; `visit` sees
/// those of each value before they go.
void find_attractors(Diagram& diagram, const RunSection& section,
                     const std::function<void(int value, const ValueSections& sections)>& visit);

/// The runs that show one attractor.
struct AttractorExtent {
  MotionClass motion;
  int first = -1, last = -1;  ///< values; −1: no run shows it
  std::set<std::size_t> cases;
  std::set<int> values;
  int symmetric = 0, asymmetric = 0, unknown = 0;  ///< runs
};
/// Of each attractor, from that with the number 1.
std::vector<AttractorExtent> extents_of(const Diagram& diagram);

/// Which cases show an attractor over the values at which it exists.
Presence presence_of(const Diagram& diagram, const AttractorExtent& extent, int attractor);

/// Share of the starts that lead there, where a case shows it at all: of the random ones where there are two or more. A
/// start counts once in the interval, however many values and cases repeat it: those are no independent trials.
Proportion fraction_of(const Diagram& diagram, const AttractorExtent& extent, int attractor);

/// A change of the motion along the parameter, as one case located it.
struct DiagramChange {
  std::string start, from, to, kind;    ///< the start that met it, the classes before and after it
  double value = 0, low = 0, high = 0;  ///< of the parameter
  /// Whether it may be the same change, seen by another case.
  bool like(const DiagramChange& other) const {
    return start == other.start && from == other.from && to == other.to && kind == other.kind;
  }
};

/// What each change of a reference became in another case: its index there, −1 where none like it is left within
/// `reach`. The nearest pairs come first; each change is taken once.
std::vector<int> match_changes(const std::vector<DiagramChange>& reference, const std::vector<DiagramChange>& here,
                               double reach);

}  // namespace ricochet
