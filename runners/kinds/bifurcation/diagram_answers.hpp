#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// What the motion is along the parameter in the finest case, which cases find the same classes as it, from which step
/// on, and how many attractors all of them have: rows of `answers`.
void say_diagram(const StudyResults& results, Table& answers);

}  // namespace ricochet
