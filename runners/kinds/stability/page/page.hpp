#pragma once
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `stability` shows: spectral radii, and where steps are stable.
namespace ricochet::report {

KindPage stability_page();

/// One row per method and contact state: predicted and observed step limit, how they agree, marginal roots, and what
/// grows first. Empty without the table `step_limits`.
std::string stability_html(const CaseView& view);

/// One row per time scheme: what a free mass keeps of its speed at a rigid stop, and ρ∞. Empty without the table
/// `restitution`.
std::string restitution_html(const CaseView& view);

}  // namespace ricochet::report
