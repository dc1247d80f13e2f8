#pragma once
#include <string>
#include <string_view>

#include "runners/store/record.hpp"

namespace ricochet::report {

/// render_report() with the chart library given: `library` empty writes the tables alone and says how to get charts.
std::string render_page(const StudyResults& results, std::string_view library, std::string_view library_version);

}  // namespace ricochet::report
