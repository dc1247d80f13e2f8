#pragma once
#include "runners/store/record.hpp"
#include "runners/table/number_table.hpp"

/// \file
/// The tables of both kinds of sweep, without rows: what their columns mean.
namespace ricochet {

/// What a sweep goes through, as columns: the parameter of a diagram, or the two axes of a grid.
struct SweptColumns {
  Column parameter{"parameter", "that of the parameter", "Value of the swept parameter."};
  Column x{"x", "that of the axis", "Value on the first axis of the grid."};
  Column y{"y", "that of the axis", "Value on the second axis of the grid."};
};
/// The same with the names and units that the study gives them.
SweptColumns swept_columns(const StudyResults& results);
/// The parameter of a study as the column of an axis would be called: "support.amplitude"; "" without one.
std::string swept_name(const StudyResults& results);

/// Of a case, kept in the store.
Table values_head(int exponents, const SweptColumns& swept = {});
Table bifurcations_head(const SweptColumns& swept = {});
Table cells_head(const SweptColumns& swept = {});
NumberTable points_head(const SweptColumns& swept = {});
NumberTable impacts_head(const SweptColumns& swept = {});
NumberTable portraits_head(const SweptColumns& swept = {});
NumberTable entries_head(const SweptColumns& swept = {});
NumberTable cell_points_head();
NumberTable contact_law_head();

/// Over all cases, worked out of these.
Table attractors_head(const SweptColumns& swept);
Table agreement_head();
Table verdicts_head(const SweptColumns& swept);
Table basin_differences_head();
/// Of single cases, worked out of these: what stands behind `case` and the axes.
Table distances_head(const SweptColumns& swept);
Table shifts_head(const SweptColumns& swept);
Table basin_fractions_head();
Table basin_uncertainty_head();

/// Gives the tables that a case of a sweep left their units and meanings.
void describe_sweep(CaseRecord& record, const SweptColumns& swept);

}  // namespace ricochet
