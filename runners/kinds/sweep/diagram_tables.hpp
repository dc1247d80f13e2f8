#pragma once
#include <ricochet/measure/attractors/presence.hpp>

#include "runners/kinds/sweep/study_diagram.hpp"

/// \file
/// The steps of derive_dynamics(), each on the diagram that the one before it left.
namespace ricochet::dynamics {

/// Fills in the attractor of every decided run. Returns `distances`: every run against the reference case's from the
/// same start, made on the way (a section is prepared once).
Table find_attractors(StudyDiagram& study);

/// Which choice an attractor hangs on, in words.
struct PresenceLabel {
  std::string label, presence, sentence;  ///< of the table `attractors`; the sentence begins in the middle
};
/// Of judge_presence(): "common to all", "vanishes under refinement", "depends on AXIS", "depends on several choices",
/// "not compared".
PresenceLabel label_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes);

Table attractors_table(const StudyDiagram& study);
Table verdicts_table(const StudyDiagram& study);
Table agreement_table(const StudyDiagram& study);
Table shifts_table(const StudyDiagram& study);

/// "signorini with 0.5": the levels of a case on the chosen axes.
std::string level_name(const std::vector<ChoiceAxis>& axes, const std::vector<std::size_t>& chosen, std::size_t c);
/// "0.0791792".
std::string short_number(double value);
/// "83 %"; "0.4 %".
std::string percent(double share);
/// "1 case", "3 cases".
std::string count_of(std::size_t count, const std::string& one);

}  // namespace ricochet::dynamics
