#pragma once
#include <string>

#include "runners/store/record.hpp"

namespace ricochet {

/// The report of a study as one HTML file: no network (a Content-Security-Policy forbids it), the chart library
/// inlined; without it (built where npm is missing) the tables alone, saying so.
std::string render_report(const StudyResults& results);

}  // namespace ricochet
