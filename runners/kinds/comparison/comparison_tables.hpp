#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// errors: one row per case and error, with the floor below which it says nothing.
Table errors_table(const StudyResults& results);

/// orders: one row per method, error and refined quantity, with the fit's verdict and reason.
Table orders_table(const StudyResults& results);

/// work_precision: one row per case and error, with the processor time it took.
Table work_precision_table(const StudyResults& results);

}  // namespace ricochet
