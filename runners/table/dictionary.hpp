#pragma once
#include "runners/table/table.hpp"

namespace ricochet {

/// dictionary: what every column of these tables means. A row without a column says what a row of the table stands
/// for. The dictionary itself is listed last.
Table dictionary_of(const std::vector<Table>& tables);

}  // namespace ricochet
