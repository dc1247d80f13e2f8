#pragma once
#include <vector>

#include "runners/run/plan_cases.hpp"

namespace ricochet {

/// What a study will take, in processor seconds of this machine.
struct Forecast {
  double seconds = 0;  ///< of the whole study
  int measured = 0;    ///< cases of which a part was marched for it
  double chain = 0;    ///< s: the longest part that no more processors shorten
  double beside = 0;   ///< s of what is done before or after the cases (references, repeats)
  double bytes = 0;    ///< of all results in the store, roughly
};

/// Marches a part of some of the cases, of as many different methods as a second or two allow, and lets the others cost
/// what those did of the same law and mesh; what takes that long to set up is left to its plan. Adds what the kind does
/// beside (references, repeats), what setting up, storing and describing a case costs. Fills predicted_seconds of each
/// plan with what was found.
///
/// It does not know cases that will diverge, and of a sweep's orbits it knows a few. Of 55 studies that were run 50
/// took what was predicted within a factor of 1.5, all of them within 1.6.
Forecast forecast(const Study& study, std::vector<PlannedCase>& cases, const CasePlanner& planner,
                  const Registry& registry);

}  // namespace ricochet
