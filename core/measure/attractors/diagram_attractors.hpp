#pragma once
#include <functional>
#include <map>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/attractors/diagram.hpp>
#include <ricochet/measure/attractors/opinions.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Attractors of a bifurcation diagram: clusters over the starts of a case, followed along the parameter, matched over
/// cases as whole branches (branches.hpp).
namespace ricochet {

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
