#pragma once
#include <string>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// Measures with what methods, step and mesh leave open, at most eight rows, for the page that a file keeps: those that
/// the study observes first, then others of its stops. "" of a study without contact.
std::string summary_measures_html(const CaseView& view);

}  // namespace ricochet::report
