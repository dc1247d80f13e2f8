#include <algorithm>
#include <atomic>

#include "runners/kinds/stability/run_stability.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

constexpr int few_steps_of_range = 4;
constexpr double longest_part = 1;  // s

}  // namespace

double rehearse_stability(const StudyCase& study_case, const Registry& registry) {
  StudyCase part = study_case;
  Json& count = part.settings["steps"]["count"];
  count = std::min(count.get<int>(), few_steps_of_range);
  part.settings["budget"] = longest_part;
  const CasePlan plan = plan_stability(part, registry);
  const std::atomic<bool> stop = false;
  const CaseRecord record = run_stability(part, registry, stop);
  if (plan.predicted_seconds <= 0 || record.steps <= 0 || record.status != "done") return 0;
  // A limit is searched for between two steps in as many marches whatever their number: what they cost is no share of
  // the range. So a step is compared, not the part.
  const double step = (record.setup_seconds + record.run_seconds) / static_cast<double>(record.steps);
  return step * static_cast<double>(plan.steps) / plan.predicted_seconds;
}

}  // namespace ricochet
