#pragma once
#include <atomic>

#include "runners/kinds/continuation/continued_map.hpp"
#include "runners/store/record.hpp"

namespace ricochet {

/// Solves the orbits of a case and follows them by steps of arclength: where pieces do not hold, or the study asks for
/// it. The same tables as run_continuation(); branches on branches are not followed.
void run_by_steps(ContinuedMap& continued, const StudyCase& study_case, const ContinuationPlan& plan,
                  const std::atomic<bool>& stop, CaseRecord& record);

}  // namespace ricochet
