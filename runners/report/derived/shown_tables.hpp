#pragma once
#include <vector>

#include "runners/report/case_view.hpp"

/// \file
/// Tables that are worked out so that figures have nothing to work out. Rows name their case by its id in the column
/// `case`, but where they speak of the study. Each is empty (no rows) where the results have nothing of the kind.
namespace ricochet::report {

/// What the energy of each case ends at, told from its start: |E(T)/E(0) − 1|, whether it was a gain, and whether
/// nothing but contact changes energies in this study.
Table energy_changes(const CaseView& view);

/// Where errors follow their fitted order: the longest run of points above their floor within a factor of two of
/// e = C x^p, with the ends of that line. Axes as in `orders`.
Table order_lines(const CaseView& view);

/// Each timed error as a point of work against precision: its floor, time per step, whether it lies on the Pareto
/// fronts of its scene, or why it has no point.
Table work_points(const CaseView& view);

/// Each step of each contact state with what was predicted and observed of it.
Table stability_cells(const CaseView& view);
/// Step limits of each contact state: predicted, observed, and expected of a marched scene, which is open as well.
Table stability_limits(const CaseView& view);
/// Ranges of neighbouring steps where prediction and observation differ.
Table stability_disagreements(const CaseView& view);

/// Distances to the reference over values and starts: median, what the middle 80 % reach, how many are exactly zero.
/// The row without a case is the null level.
Table distance_spreads(const CaseView& view);
/// The median over the starts at each value of the parameter; rows without a case are the null level.
Table distance_medians(const CaseView& view);

/// How often each method gave an exponent, and at how many values and starts one of a marginal root is set apart.
Table exponent_methods(const CaseView& view);

/// Cells of each grid of basins: how many, filled in, and how many differ from the first case's.
Table basin_counts(const CaseView& view);
/// Why cells failed, and how many.
Table basin_failures(const CaseView& view);

/// What the shares of each measure's variance say, as a sentence, with what they leave out.
Table effects_said(const CaseView& view);

/// Those of all these tables that have rows and that the results do not hold already.
std::vector<Table> shown_tables(const StudyResults& results);

}  // namespace ricochet::report
