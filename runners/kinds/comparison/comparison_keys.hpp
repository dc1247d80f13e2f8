#pragma once
#include "runners/study/field.hpp"

/// \file
/// What the kinds that compare each case with a reference add to a study.
namespace ricochet {

/// The errors that a comparing study may ask for, in the order of its tables.
const std::vector<std::string>& error_names();

/// step, duration, samples, reference, errors, horizon, budget.
std::vector<Field> comparison_keys();

/// Refuses a horizon beyond the duration.
void check_comparison(const Json& resolved);

}  // namespace ricochet
