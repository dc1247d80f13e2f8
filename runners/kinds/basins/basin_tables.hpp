#pragma once
#include "runners/store/record.hpp"

namespace ricochet::dynamics {

/// Appends the tables of kind `basins` to results.derived: cells, attractors, basin_fractions, basin_differences,
/// basin_uncertainty (see runners/kinds/sweep/sweep_tables.hpp). Which cells end alike is told by one rule
/// (core/measure/attractors/attractors.hpp), by which the cases refined their grids as well: a motion and its mirror
/// image are one attractor.
void derive_basins(StudyResults& results);

}  // namespace ricochet::dynamics
