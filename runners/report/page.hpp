#pragma once
#include <string>
#include <string_view>

#include "runners/report/kind_page.hpp"

namespace ricochet::report {

/// render_report() with the chart library given: `library` empty writes the tables alone and says how to get charts.
std::string render_page(const StudyResults& results, const KindPage& kind, std::string_view library,
                        std::string_view library_version);

/// The section "Answer" as HTML: what the kind says, or why there is nothing to say.
std::string answer_html(const CaseView& view, const KindPage& kind);

}  // namespace ricochet::report
