#pragma once
#include "runners/store/record.hpp"

/// \file
/// What a bifurcation diagram, or an image of basins, owes to its methods: the tables worked out of the `values`,
/// `bifurcations` and `points` (or `cells` and `cell_points`) that the cases leave.
///
/// Clouds of section points live in (tip displacement, tip velocity), each divided by its standard deviation over all
/// section points of the study and the motions' places half a period later (so that a study of one orbit is measured
/// against its motion): distances are without unit. Clouds of more than 64 points are thinned evenly to that. See
/// core/measure/attractors: point_clouds.hpp (distances, their null), attractors.hpp (what counts as one attractor at
/// one value), branches.hpp (along the parameter) and basin_grid.hpp.
///
/// *Reference case*: of the cases with the stiffest contact (a rigid one, where there is one; the law tells) the one
/// with the most steps per period, then the most elements, then the first of the study that has anything to compare
/// with.
///
/// What the columns of these tables mean is declared in sweep_tables.hpp. A change of shifts is one of the same kind,
/// classes and start, the nearest within a tenth of the values' range; changes from or to "undecided" are left out.
/// Intervals of verdicts touch: they end half way between two values. Of kind `basins` a motion and its mirror image
/// are one attractor.
namespace ricochet {

/// Whether a table of the cases is among those that are collected.
bool derived_as_dynamics(const std::string& table);

/// Appends the tables of a bifurcation diagram to results.derived; an unfinished study has partial ones. Failed values
/// make no attractor.
void derive_dynamics(StudyResults& results);

}  // namespace ricochet
