#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// Rows of `answers`: over how much of the parameter's range the methods agree, depend on a choice, or leave it open;
/// then every interval of `verdicts` with its sentence, those that a choice decides first.
Table bifurcation_answers(const StudyResults& results);

}  // namespace ricochet
