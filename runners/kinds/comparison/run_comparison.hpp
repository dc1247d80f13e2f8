#pragma once
#include "runners/kinds/comparison/references.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"

namespace ricochet {

/// Runs one case of kind `convergence` or `work-precision` and compares it with its references.
///
/// Measures: error.NAME and floor.NAME for each error of the study (see motion_errors.hpp) against the first reference
/// that applies. The floor is the larger of that reference's own gap and its distance to the other references. Further
/// horizon (s), and declared_order where the scheme declares one for such a run. Status `refused` when no reference
/// applies.
CaseRecord run_comparison(const StudyCase& study_case, const Registry& registry, References& references,
                          const std::atomic<bool>& stop);

/// Marching time of one case alone, s of processor: set-up apart, nothing observed, no sample taken. None when the case
/// does not reach its end.
std::optional<double> time_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

}  // namespace ricochet
