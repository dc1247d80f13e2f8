#pragma once
#include <string>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// Sixteen hexadecimal digits that tell studies apart by what was asked and what answered: the resolved study, the
/// commit, the plugins' bytes.
std::string study_fingerprint(const StudyResults& results);

/// What a file of qualification keeps of a study, made to fit one sheet: question, sketch of the scene with its
/// numbers, answer, a place for the figure, methods, limits, identity. The first page of a printed report.
std::string summary_html(const CaseView& view);

/// The style of the printed pages' margins: which study, which fingerprint, when it ran, which page of how many.
std::string page_margins(const StudyResults& results);

}  // namespace ricochet::report
