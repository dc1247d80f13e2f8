#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "runners/report/kind_page.hpp"
#include "runners/store/record.hpp"

namespace ricochet::report {

/// The section "Answer" as HTML: what the kind says, or why there is nothing to say.
std::string answer_html(const Choices& choices, const KindPage& kind);

}  // namespace ricochet::report

namespace ricochet {

/// The report of a study as one HTML file. It uses no network (a Content-Security-Policy forbids it): its scripts,
/// which draw the charts, stand in it. `kind` says what the kind of study shows.
std::string render_report(const Choices& choices, const report::KindPage& kind);

}  // namespace ricochet

namespace ricochet::report {

/// Cases that the figures and the table of cases of one page hold where a study has more than twice as many.
constexpr std::size_t most_shown_cases = 2000;

/// The results without the cases that a page leaves out of its figures and of its table of cases. Their rows in derived
/// tables are left out, too. Nothing where all are shown: up to 2 × most_shown_cases of them. Shown are the first case
/// of each value of an axis, and cases that are not done. Each of the two fills a quarter of most_shown_cases at most.
/// Others follow in the order of their ids, which are hashes: drawn by lot, and the same ones each time.
std::optional<StudyResults> shown_cases(const StudyResults& results);

/// How many of how many are shown, and where all are.
std::string shown_sentence(const StudyResults& shown, const StudyResults& all);

}  // namespace ricochet::report
