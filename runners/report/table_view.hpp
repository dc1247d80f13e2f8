#pragma once
#include <string>

#include "runners/store/record.hpp"

namespace ricochet::report {

/// The derived tables of the results as folded HTML tables that a click on a header sorts; the first rows of each, and
/// how many more its CSV file has. Empty where nothing was derived.
std::string derived_tables_html(const StudyResults& results);

}  // namespace ricochet::report
