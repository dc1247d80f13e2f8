#pragma once
#include "runners/kinds/kind.hpp"
#include "runners/study/fields.hpp"

/// \file
/// What the kinds that compare each case with a reference add to a study.
namespace ricochet {

/// The errors that a comparing study may ask for, in the order of its tables.
const std::vector<std::string>& error_names();

/// step, duration, samples, reference, errors, horizon, budget.
std::vector<Field> comparison_keys();

/// Refuses a horizon beyond the duration.
void check_comparison(const Json& resolved);

// What the kinds that compare each case with a reference share.

/// The settings of a comparing case: reference, errors, horizon, repeats (where the kind times), budget.
Json comparison_settings(const Json& resolved);

/// Runs cases against references that are computed once; a study none of whose scenes has one is refused before
/// anything runs.
CaseRunner compare_cases(const RunContext& context);

/// References, repeats, and what reading and comparing motions takes.
double seconds_beside(const ForecastContext& context);

/// "tip-linf 1.23e-04, …": the first errors of a case; without any, what it says as a trajectory.
std::string errors_text(const CaseRecord& record);

/// The measures of every comparison: errors, their floors, how they were found.
std::vector<MeasureInfo> comparison_measures();

}  // namespace ricochet
