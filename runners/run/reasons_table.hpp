#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// reasons: why cases have no result, each reason once with the number of cases that give it; no rows where all are
/// done.
Table reasons_table(const StudyResults& results);

}  // namespace ricochet
