#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// What the motion is along the parameter in the finest case, which cases find the same classes as it, from which step
/// on, and how many attractors all of them have: rows of `answers`.
void say_diagram(const StudyResults& results, Table& answers);

/// Rows of `answers`: over how much of the parameter's range the methods agree, depend on a choice, or leave it open;
/// then every interval of `verdicts` with its sentence, those that a choice decides first.
Table bifurcation_answers(const StudyResults& results);

}  // namespace ricochet
