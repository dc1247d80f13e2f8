#pragma once
#include "runners/kinds/sweep/derive_dynamics_diagram.hpp"

/// \file
/// The steps of derive_dynamics(), each on the diagram that the one before it left.
namespace ricochet::dynamics {

/// Fills in the attractor of every decided run: clusters over the starts of a case, followed along the parameter,
/// matched over cases as whole branches. Returns `distances`: every run against the reference case's from the same
/// start, made on the way (a section is prepared once).
DerivedTable find_attractors(Diagram& diagram);

/// One attractor over the cases that could tell.
struct Presence {
  std::vector<std::size_t> cases;  ///< indices of the cases that decided something where it exists
  std::vector<int> present;        ///< of each, 1 or 0: whether it shows there half as often as in any case, or more
};

constexpr double kNamed = 0.5;  ///< share of the differences from which a choice is named

/// Which choice an attractor hangs on, in words.
struct PresenceLabel {
  std::string label, presence, sentence;  ///< of the table `attractors`; the sentence begins in the middle
};
/// `axes` hold a level for each case of the study. "common to all" where every case shows it; "vanishes under
/// refinement" where none of the finest cases (most steps per period and elements, other choices being equal) does, and
/// a coarser one does; else "depends on AXIS", or "depends on several choices" where no axis tells half of it; "not
/// compared" with fewer than two cases.
PresenceLabel label_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes);

DerivedTable attractors_table(const Diagram& diagram);
DerivedTable verdicts_table(const Diagram& diagram);
DerivedTable agreement_table(const Diagram& diagram);
DerivedTable shifts_table(const Diagram& diagram);

/// "0.0791792".
std::string short_number(double value);
/// "83 %"; "0.4 %".
std::string percent(double share);
/// "1 case", "3 cases".
std::string count_of(std::size_t count, const std::string& one);

}  // namespace ricochet::dynamics
