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
/// Tables, each after `case` (the id) and the axes where it speaks of one case:
///
/// values        the cases' rows with `attractor` filled in: a whole number that is the same for every case and start
/// bifurcations  the cases' rows
/// attractors    attractor, label, cases (how many have it), from, to (values of the parameter), class, period,
///               symmetric, fraction, fraction_low, fraction_high (of the starts, where it exists, 95 % after Wilson),
///               presence ("time.beta 0.25: 3 of 3, 0.5: 0 of 3"), sentence.
///               label: "common to all" | "depends on AXIS" | "depends on several choices" | "vanishes under
///               refinement" | "not compared"
/// distances     reference_case, parameter, start, wasserstein, hausdorff, null_wasserstein, null_hausdorff, ratio
///               (wasserstein / null_wasserstein), same_class, formula ("exact" | "sliced")
/// shifts        reference_case, start, from, to (classes), kind, reference_value, value, shift, low, high, found
///               A change of the same kind, classes and start, the nearest within a tenth of the values' range; changes
///               from or to "undecided" are left out
/// agreement     case, other_case, compared (values × starts), same_class, share (same_class / compared),
///               same_attractor, share_attractor: one row per ordered pair, also of a case with itself
/// verdicts      from, to, verdict ("robust" | "depends" | "undecided"), choice (an axis, "several choices", or ""),
/// sentence. Intervals
///               touch: they end half way between two values.
///
/// Of kind `basins` (a motion and its mirror image are one attractor): cells (the cases' rows, `attractor` one over all
/// cases), attractors (from and to null),
/// basin_fractions      attractor, class, period, cells, fraction, low, high
/// basin_differences    case, other_case, cells (decided in both), differ, share
/// basin_uncertainty    boundary_share, exponent, low, high
namespace ricochet {

/// Whether the study's cases leave sections: kinds `bifurcation` and `basins`.
bool has_dynamics(const StudyResults& results);
/// Whether a table of the cases is among those that derive_dynamics() collects.
bool derived_as_dynamics(const std::string& table);

/// Appends the tables above to results.derived; an unfinished study has partial ones. Failed values make no attractor.
void derive_dynamics(StudyResults& results);

}  // namespace ricochet
