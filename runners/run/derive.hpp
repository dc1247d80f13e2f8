#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// Works out the tables that stand beside cases.csv from the cases alone, those that the study's kind has: errors,
/// orders and work_precision; stability and its limits; the energies of trajectories; those of derive_dynamics();
/// effects wherever at least two factors vary. Tells the tables of the cases what their columns mean. Rows speak of
/// finished cases only; a partial study has partial tables.
void derive_tables(StudyResults& results);

/// The same, returned.
inline StudyResults with_tables(StudyResults results) {
  derive_tables(results);
  return results;
}

}  // namespace ricochet
