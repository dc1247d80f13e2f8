#pragma once
#include <functional>

#include "runners/store/record.hpp"

namespace ricochet {

/// Appends the tables that cases carry to results.derived, each row behind its case's axes. `left_out` (may be empty)
/// names those that the kind derives itself.
void collect_tables(StudyResults& results, const std::function<bool(const std::string& table)>& left_out = {});

}  // namespace ricochet
