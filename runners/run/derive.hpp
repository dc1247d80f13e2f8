#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// Works out the tables that stand beside cases.csv from the cases alone: those of the study's kind, then effects
/// wherever at least two factors vary. Rows speak of finished cases only; a partial study has partial tables.
void derive_tables(StudyResults& results);

/// The same, returned.
inline StudyResults with_tables(StudyResults results) {
  derive_tables(results);
  return results;
}

}  // namespace ricochet
