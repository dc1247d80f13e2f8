#pragma once
#include "runners/kinds/sweep/sweep_tables.hpp"

/// \file
/// What the orbits of a bifurcation study come to, over values and starts.
namespace ricochet {

/// verdict_shares: for each verdict and deciding choice, how many intervals and which share of the range; robust first,
/// undecided last.
Table verdict_shares_table(const Table& verdicts, const SweptColumns& swept);

/// class_counts: for each case and class, the orbits that have it.
Table class_counts_table(const StudyResults& results);

/// grazing_ranges: for each start, where contact begins or ends, over the cases.
Table grazing_ranges_table(const StudyResults& results, const SweptColumns& swept);

/// numerical_viscosity: for each case, what its scheme adds to the viscosity of the scene.
Table numerical_viscosity_table(const StudyResults& results);

}  // namespace ricochet
