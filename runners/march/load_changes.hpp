#pragma once
#include <string>
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// What steps of `step` (s) from t = 0 on do not resolve of a load that is a formula in t, a sentence each: that it
/// comes and goes within a step (no step sees it, or one instant alone), and that it jumps. L being the largest load:
///
///     comes and goes    inside of a step it is beyond both of its ends by more than L/10, or at one end it is beyond
///                       the ends before and behind by more than L/2 (both are met by a wave of six steps and less);
///     jumps             by more than L/4 in a step, half of it or more in an eighth of that step.
///
/// Looks at a quarter of the steps, 500 to 2500 of them, spread evenly, and closely around the numbers that stand in
/// the formulas: what it does not find may be there. Costs half a millisecond at most where a formula takes 100 ns.
/// Empty where no load is a formula in t.
std::vector<std::string> load_changes(const SceneSpec& scene, double step, long long steps);

}  // namespace ricochet
