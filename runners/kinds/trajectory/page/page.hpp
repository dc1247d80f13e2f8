#pragma once
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `trajectory` shows: energies over time and at the end.
namespace ricochet::report {

KindPage trajectory_page();

/// What the energy of each case ends at, told from its start: |E(T)/E(0) − 1|, whether it was a gain, and whether
/// nothing but contact changes energies in this study.
Table energy_changes(const CaseView& view);

}  // namespace ricochet::report
