#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// Works out the tables that stand beside cases.csv from the cases alone: errors, orders, work_precision, stability,
/// effects, and those of derive_dynamics() (those that the study's kind has; effects wherever at least two factors
/// vary). Rows speak of finished cases
/// only; a partial study has partial tables.
void derive_tables(StudyResults& results);

/// The same, returned.
inline StudyResults with_tables(StudyResults results) {
  derive_tables(results);
  return results;
}

}  // namespace ricochet
