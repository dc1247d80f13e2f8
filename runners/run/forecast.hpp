#pragma once
#include <string>
#include <vector>

#include "runners/run/plan_cases.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What a study will take, in processor seconds of this machine.
struct Forecast {
  double seconds = 0;  ///< of the whole study
  double chain = 0;    ///< s: the longest part that no more processors shorten
  double beside = 0;   ///< s of what is done before or after the cases (references, repeats)
  double bytes = 0;    ///< of all results in the store, roughly
};

/// Sums what the cost model says of each case, adds what the kind does beside (references, repeats), and setting up,
/// storing and describing cases. Fills predicted_seconds of each plan. Within a factor of 3: contact, divergence and
/// transients are not foreseen.
Forecast forecast(const Study& study, std::vector<PlannedCase>& cases, const Registry& registry);

/// Cases of the same key cost about the same: the same methods, mesh, steps and settings, in scenes whose numbers
/// differ in size alone. One that is 0 here and not there sets cases apart, as what it feeds is left out.
std::string cost_key(const StudyCase& study_case);

}  // namespace ricochet
