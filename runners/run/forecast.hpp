#pragma once
#include <vector>

#include "runners/run/plan_cases.hpp"

namespace ricochet {

/// What a study will take, in processor seconds of this machine.
struct Forecast {
  double seconds = 0;  ///< of the whole study
  double longest = 0;  ///< of its longest case, which bounds a run on many cores
  int measured = 0;    ///< cases of which a part was marched for it
};

/// Marches a part of some of the cases, of as many different methods as a second or two allow, and lets the others cost
/// what those did of the same law and mesh; adds what the kind does beside (references, repeats), what setting up,
/// storing and describing a case costs. Fills predicted_seconds of each plan with what was found.
///
/// It knows neither orbits that settle early or never, nor cases that will diverge. Of 23 studies that ship 19 took
/// what was predicted within a factor of 1.8, the others (references that are solved or shared) within 3.
Forecast forecast(const Study& study, std::vector<PlannedCase>& cases, const CasePlanner& planner,
                  const Registry& registry);

}  // namespace ricochet
