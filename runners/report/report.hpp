#pragma once
#include <string>

#include "runners/report/kind_page.hpp"

namespace ricochet {

/// The report of a study as one HTML file: no network (a Content-Security-Policy forbids it), the chart library
/// inlined; `kind` says what the kind of study shows. Without the library (built where npm is missing) the tables
/// alone, saying so.
std::string render_report(const StudyResults& results, const report::KindPage& kind);

}  // namespace ricochet
