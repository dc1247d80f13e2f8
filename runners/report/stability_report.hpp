#pragma once
#include <string>

#include "runners/report/case_view.hpp"

/// \file
/// The sections of a report of kind `stability`, from the tables that its cases carry. Empty where they carry none.
namespace ricochet::report {

/// One row per method and contact state: predicted and observed step limit, how they agree, marginal roots, and what
/// grows first.
std::string stability_html(const CaseView& view);

}  // namespace ricochet::report
