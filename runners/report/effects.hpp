#pragma once
#include <string>

#include "runners/report/case_view.hpp"

/// \file
/// How much of each measure's variance is owed to each choice, from the table `effects`. Every kind's page has it.
namespace ricochet::report {

/// What the shares of each measure's variance say, as a sentence, with what they leave out.
Table effects_said(const CaseView& view);

/// One sentence to quote per measure, what the shares leave out, and the table of shares. Empty without the table.
std::string effects_html(const CaseView& view);

}  // namespace ricochet::report
