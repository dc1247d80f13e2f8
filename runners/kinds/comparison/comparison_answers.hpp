#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// Rows of `answers` on orders in the step, one per time scheme: whether what was fitted is what it declares.
void say_orders(const StudyResults& results, Table& answers);

/// Rows of `answers` on what to take: the cheapest method for a relative error of 1 %, 0.1 %, …, and who does not get
/// there; of the first error that the study asks for, in each of its scenes.
void say_precision(const StudyResults& results, Table& answers);

}  // namespace ricochet
