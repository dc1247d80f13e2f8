#pragma once
#include <ricochet/measure/attractors/diagram.hpp>

#include "runners/kinds/sweep/study_diagram.hpp"
#include "runners/store/record.hpp"

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

namespace ricochet {

// What a bifurcation diagram, or an image of basins, owes to its methods: the tables worked out of the `values`,
// `bifurcations` and `points` (or `cells` and `cell_points`) that the cases leave.
//
// Clouds of section points live in (tip displacement, tip velocity), without unit. Each is divided by its standard
// deviation over all section points of the study and the motions' places half a period later. A study of one orbit is
// so measured against its motion. Clouds of more than 64 points are thinned evenly to that. See
// core/measure/attractors: attractors.hpp (distances, their null, what counts as one attractor at one value, along the
// parameter) and basin_grid.hpp.
//
// *Reference case*: of the cases with the stiffest contact (a rigid one, where there is one; the law tells) the one
// with the most steps per period, then the most elements, then the first of the study that has anything to compare
// with.
//
// What the columns of these tables mean is declared in sweep_tables.hpp. A change of shifts is one of the same kind,
// classes and start, the nearest within a tenth of the values' range; changes from or to "undecided" are left out.
// Intervals of verdicts touch: they end half way between two values. Of kind `basins` a motion and its mirror image
// are one attractor.

/// Whether a table of the cases is among those that are collected.
bool derived_as_dynamics(const std::string& table);

/// Appends the tables of a bifurcation diagram to results.derived; an unfinished study has partial ones. Failed values
/// make no attractor.
void derive_dynamics(StudyResults& results);

}  // namespace ricochet
